"use strict";
(() => {
  // Sheets: drawn when they come into view, at most a few at a time, as browsers allow no more.
  const MOST = 6;
  const alive = new Map();
  const options = (stage) => JSON.parse(stage.querySelector('script[type="application/json"]').textContent);

  function open(stage) {
    if (alive.has(stage) || stage.classList.contains("flat")) return;
    try {
      alive.set(stage, Sheets.createViewer(stage, options(stage)));
    } catch {
      stage.classList.add("flat");
      const said = document.createElement("p");
      said.textContent = "This browser draws nothing in three dimensions: WebGL is off or missing.";
      stage.querySelector(".sv")?.remove();
      stage.append(said);
      stage.querySelector(".instead")?.removeAttribute("hidden");
    }
    for (const [other] of alive) {
      if (alive.size <= MOST) break;
      if (other !== stage && !other.classList.contains("near")) close(other);
    }
  }

  function close(stage) {
    stage.style.minHeight = `${stage.offsetHeight}px`; // so that the page does not jump
    alive.get(stage).dispose();
    alive.delete(stage);
  }

  const watch = new IntersectionObserver(
    (entries) => {
      for (const { target, isIntersecting } of entries) {
        target.classList.toggle("near", isIntersecting);
        if (isIntersecting) open(target);
      }
    },
    { rootMargin: "200px" },
  );
  const stages = Array.from(document.querySelectorAll(".stage"));
  stages.forEach((stage) => watch.observe(stage));

  // Print: pictures stand for sheets, and everything is open.
  addEventListener("beforeprint", () => {
    for (const details of document.querySelectorAll("details:not([open])")) {
      details.open = true;
      details.classList.add("shut");
    }
    for (const stage of stages) {
      const was = alive.has(stage);
      open(stage);
      const viewer = alive.get(stage);
      if (!viewer) continue;
      stage.querySelector(".taken")?.remove();
      const taken = document.createElement("img");
      taken.className = "taken";
      taken.alt = stage.dataset.label;
      taken.src = viewer.picture();
      viewer.stage.after(taken);
      if (!was && stages.length > MOST) {
        stage.append(taken);
        close(stage);
      }
    }
  });
  addEventListener("afterprint", () => {
    for (const details of document.querySelectorAll("details.shut")) {
      details.open = false;
      details.classList.remove("shut");
    }
    document.querySelectorAll(".taken").forEach((taken) => taken.remove());
  });

  // Tables: a heading sorts, numbers by their value, words as words; what has no value comes last.
  const words = new Intl.Collator(undefined, { numeric: true });

  function sort(heading) {
    const table = heading.closest("table");
    const column = heading.cellIndex;
    const down = heading.getAttribute("aria-sort") === "ascending";
    const value = (row) => {
      const cell = row.cells[column];
      return cell.dataset.value !== undefined ? Number(cell.dataset.value) : heading.classList.contains("number") ? null : cell.textContent;
    };
    const compare = (a, b) => {
      if (a === null || b === null || Number.isNaN(a) || Number.isNaN(b)) {
        const empty = (v) => v === null || Number.isNaN(v);
        return empty(a) - empty(b);
      }
      return (down ? -1 : 1) * (typeof a === "number" ? a - b : words.compare(a, b));
    };
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const body = table.tBodies[0];
    body.append(...Array.from(body.rows).sort((a, b) => compare(value(a), value(b))));
  }
  for (const button of document.querySelectorAll("th button")) {
    button.addEventListener("click", () => sort(button.parentElement));
  }
})();
