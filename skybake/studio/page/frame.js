// Pictures as the server sends them: a length, a JSON header, half floats.

/**
 * Read a binary message.
 * @param {ArrayBuffer} buffer
 * @returns {{texels: Uint16Array}} fields of the header, and texels row by row.
 */
export function readFrame(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const start = 4 + length;
  const header = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  const texels = start % 2 ? new Uint16Array(buffer.slice(start)) : new Uint16Array(buffer, start);
  return { ...header, texels };
}
