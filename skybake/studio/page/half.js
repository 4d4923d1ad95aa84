// Half floats as numbers, by a table of all of them.

const table = new Float32Array(65536);
for (let bits = 0; bits < 65536; bits += 1) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) table[bits] = sign * fraction * 2 ** -24;
  else if (exponent === 31) table[bits] = fraction ? NaN : sign * Infinity;
  else table[bits] = sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

/** Number of each of the 65536 half floats. */
export const HALF = table;
