(() => {
  "use strict";
  const at = (id) => document.getElementById(id);
  const studies = JSON.parse(at("studies").textContent);
  let viewer;
  function show({ title, subtitle, options }) {
    viewer?.dispose();
    at("title").textContent = title;
    at("subtitle").textContent = subtitle;
    viewer = window.viewer = Sheets.createViewer(at("stage"), { ...options, label: `Sheet of ${title}` });
  }
  at("study")?.addEventListener("change", (event) => show(studies[Number(event.target.value)]));
  show(studies[0]);
})();
