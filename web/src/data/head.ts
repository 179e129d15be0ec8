// Arrays that begin with a JSON text.

// Returns the JSON at the begin of an array, and where the rest begins.
export function readHead<T>(bytes: ArrayBuffer): [T, number] {
  const size = new DataView(bytes).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size))) as T, 4 + size];
}
