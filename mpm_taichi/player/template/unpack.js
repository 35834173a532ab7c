// Blocks of text back to whole numbers: the inverse of mpm_taichi/player/packing.py.

/** Base64 of deflated bytes, in the element of an id, which is then removed -> Uint8Array. */
async function inflated(id) {
  const element = document.getElementById(id);
  const letters = atob(element.textContent);
  element.remove();
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) bytes[i] = letters.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Writes the frames [start, end) of a channel, typed array [frames, n], from the bytes at `at`;
 *  returns where its bytes end. */
function unpackChannel(bytes, at, channel, n, start, end) {
  const way = bytes[at++], order = way & 3, beside = way >> 2;
  const wide = channel.BYTES_PER_ELEMENT == 2, values = (end - start) * n;
  for (let k = start; k < end; k++) {
    const a = Math.max(k - 1, 0) * n, b = Math.max(k - 2, 0) * n;  // one and two frames before
    const last = k > 0 && order > 0 ? (order == 2 ? 2 : 1) : 0, beforeLast = last == 2 ? 1 : 0;
    let sum = 0;
    for (let p = 0, q = k * n; p < n; p++, q++, at++) {
      const zigzag = wide ? bytes[at] | bytes[at + values] << 8 : bytes[at];
      const difference = (zigzag >>> 1) ^ -(zigzag & 1);
      sum = beside ? sum + difference : difference;
      channel[q] = sum + (last ? last * channel[a + p] - beforeLast * channel[b + p] : 0);
    }
  }
  return at + (wide ? values : 0);
}

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  for (let bit = 0; bit < 8; bit++) byte = byte & 1 ? (byte >>> 1) ^ 0xedb88320 : byte >>> 1;
  return byte;
});

/** CRC-32 of bytes that follow those of which it was `crc`. */
function crc32(bytes, crc = 0) {
  crc = ~crc;
  for (let i = 0; i < bytes.length; i++) crc = (crc >>> 8) ^ CRC_TABLE[(crc ^ bytes[i]) & 255];
  return ~crc >>> 0;
}
