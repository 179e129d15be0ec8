// SPDX-License-Identifier: Apache-2.0
// Arrays that begin with the length of a JSON text and this text (doc/formats/page_data.md, POST live).

// Returns the JSON at the beginning of an array, and the index of the byte behind it.
export function readHead<T>(bytes: ArrayBuffer): [T, number] {
  const size = new DataView(bytes).getUint32(0, true);
  return [JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size))) as T, 4 + size];
}
