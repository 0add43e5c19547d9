// Deformed sheets in a browser, to be turned, coloured and played: `Sheets.createViewer(element, options)`.
//
// options: {sheets, views, outline, from, label, controls, exaggeration, quick}
//   sheets: [{name, label, style: "surface" | "lattice", points, displacement, quads, triangles, lines, faint,
//             strong, held: [{points, firm}], forces: [{point, at, along}], fields, frames: [{time, displacement}]}]
//     points (3 n) at rest and displacement (3 n) in metres; the rest are numbers of points: four a quad, three
//     a triangle, two a line (dark), a faint one, a strong one (red); held: along a support;
//     forces: arrows along a vector [m], at a place [m] that moves as a point does.
//     fields: [{name, label, unit, scale, kind: "magnitude" | "signed" | "difference", values | component, limits}]
//       values (n), shown times scale in the unit; without values a component ("x", "y", "z") of the
//       displacement, or its length. limits [low, high] of the colours; without them those of the values.
//   views: [{name, label, sheets: [names], field}], what "Show" offers; one a sheet unless given.
//   outline: (3 p) [m], the undeformed sheet's corners in turn. from: direction of the eye. label: what the
//   view is called for those who do not see it. controls: false for a page with a toolbar of its own.
//   quick: no smooth edges where the processor draws, for a page whose answers should be drawn soon.
// Numbers are typed arrays, lists, or {float32: base64} and {uint32: base64}.
//
// viewer: setSheet(view), setField(name), update(sheet, {displacement, values: {field: numbers}, forces}) as often as
// one likes (drawn once a frame of the screen), setSheets(sheets, views), setTime(seconds),
// setExaggeration(times), setOutline(visible), reset(), picture(), dispose().
//
// Needs viewer.css; no eval, no style attribute, no request: a strict content security policy holds.

import { Viewer } from "./viewer.js";

// Raises an Error where the browser draws nothing in three dimensions.
export const createViewer = (element, options) => new Viewer(element, options);
export { ticks, number } from "./shown.js";
