// Elements of the page: no text is ever read as markup.

let made = 0;

export function element(kind, attributes = {}, parent = null) {
  const found = document.createElement(kind);
  for (const [name, value] of Object.entries(attributes)) found.setAttribute(name, value);
  parent?.append(found);
  return found;
}

export const unique = (word) => `sv-${word}-${++made}`;

// A control with its label before it.
export function labelled(parent, text, kind, attributes = {}) {
  const id = unique("control");
  const box = element("span", { class: "sv-control" }, parent);
  element("label", { for: id }, box).textContent = text;
  return element(kind, { id, ...attributes }, box);
}

export function choices(select, options) {
  select.replaceChildren();
  for (const [value, text] of options) element("option", { value }, select).textContent = text;
}
