// Numbers of a page: typed arrays, plain lists (nested or flat), or little-endian bytes in base64 as the
// Python side packs them, {"float32": "…"} or {"uint32": "…"}.

function bytes(text) {
  const raw = atob(text);
  const found = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) found[i] = raw.charCodeAt(i);
  return found.buffer;
}

export function floats(given) {
  if (given instanceof Float32Array) return given;
  if (given.float32 !== undefined) return new Float32Array(bytes(given.float32));
  return Float32Array.from(Array.isArray(given) ? given.flat() : given);
}

export function indices(given) {
  if (given === undefined || given === null) return new Uint32Array(0);
  if (given instanceof Uint32Array) return given;
  if (given.uint32 !== undefined) return new Uint32Array(bytes(given.uint32));
  return Uint32Array.from(Array.isArray(given) ? given.flat() : given);
}
