// SPDX-License-Identifier: Apache-2.0
// Reads what app/export/page_numbers.cpp writes.

async function inflated(base64) {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Tables of whole numbers, one after another. Of each, the bytes of all numbers with the same weight lie together. A
// number is the difference from what the rows before it predict: `order` 0 = nothing, 1 = the same as in the last row,
// 2 = the same change as from the last but one.
function tablesOf(bytes, descriptions) {
  const tables = {};
  let begin = 0;
  for (const { name, rows, columns, order, width } of descriptions) {
    const count = rows * columns, values = new Int32Array(count);
    for (let i = 0; i < count; ++i) {
      let zigzag = 0;
      for (let byte = 0; byte < width; ++byte) zigzag |= bytes[begin + byte * count + i] << (8 * byte);
      let value = (zigzag >>> 1) ^ -(zigzag & 1);
      if (order > 0 && i >= columns) value += values[i - columns];
      if (order > 1 && i >= 2 * columns) value += values[i - columns] - values[i - 2 * columns];
      values[i] = value;
    }
    begin += width * count;
    tables[name] = values;
  }
  if (begin !== bytes.length) throw new Error("the page is damaged");
  return tables;
}
