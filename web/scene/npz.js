// NumPy's .npz: a zip file of .npy arrays. Reads stored and deflated entries, writes stored ones.

const TYPES = {
  "<f4": Float32Array,
  "<f8": Float64Array,
  "<u4": Uint32Array,
  "<i4": Int32Array,
  "<u8": BigUint64Array,
  "<i8": BigInt64Array,
  "|u1": Uint8Array,
  "|i1": Int8Array,
  "<u2": Uint16Array,
  "<i2": Int16Array,
};

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
  return c >>> 0;
});

function crc32(bytes) {
  let c = 0xffffffff;
  for (let i = 0; i < bytes.length; i++) c = CRC[(c ^ bytes[i]) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** The .npy bytes of an array { data, shape }. */
function npy({ data, shape }) {
  const type = Object.keys(TYPES).find((t) => TYPES[t] === data.constructor);
  if (!type) throw new Error(`no NumPy type for ${data.constructor.name}`);
  const tuple = shape.length === 1 ? `(${shape[0]},)` : `(${shape.join(", ")})`;
  let header = `{'descr': '${type}', 'fortran_order': False, 'shape': ${tuple}, }`;
  header = header.padEnd(Math.ceil((header.length + 11) / 64) * 64 - 11) + "\n";
  const out = new Uint8Array(10 + header.length + data.byteLength);
  out.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, header.length & 255, header.length >> 8]);
  out.set(new TextEncoder().encode(header), 10);
  out.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), 10 + header.length);
  return out;
}

/** The bytes of an .npz file of arrays { name: { data, shape } }. */
export function writeNpz(arrays) {
  const parts = [];
  const directory = [];
  let at = 0;
  for (const [key, array] of Object.entries(arrays)) {
    const name = new TextEncoder().encode(`${key}.npy`);
    const data = npy(array);
    const fields = new DataView(new ArrayBuffer(26));
    // Version 2.0, no flags, stored, 1 January 1980.
    [20, 0, 0, 0, 33].forEach((value, i) => fields.setUint16(2 * i, value, true));
    [crc32(data), data.length, data.length].forEach((value, i) => fields.setUint32(10 + 4 * i, value, true));
    fields.setUint16(22, name.length, true);
    const common = new Uint8Array(fields.buffer);
    const local = new Uint8Array([0x50, 0x4b, 3, 4, ...common, ...name]);
    const central = new Uint8Array(46 + name.length);
    central.set([0x50, 0x4b, 1, 2, 20, 0, ...common]);
    new DataView(central.buffer).setUint32(42, at, true);
    central.set(name, 46);
    directory.push(central);
    parts.push(local, data);
    at += local.length + data.length;
  }
  const size = directory.reduce((sum, d) => sum + d.length, 0);
  const end = new DataView(new ArrayBuffer(22));
  end.setUint32(0, 0x06054b50, true);
  end.setUint16(8, directory.length, true);
  end.setUint16(10, directory.length, true);
  end.setUint32(12, size, true);
  end.setUint32(16, at, true);
  const all = [...parts, ...directory, new Uint8Array(end.buffer)];
  const out = new Uint8Array(all.reduce((sum, p) => sum + p.length, 0));
  let offset = 0;
  for (const part of all) {
    out.set(part, offset);
    offset += part.length;
  }
  return out;
}

/** The arrays of an .npz file: { name: { data, shape } }. */
export async function readNpz(buffer) {
  const bytes = new Uint8Array(buffer);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  let end = bytes.length - 22;
  while (end >= 0 && view.getUint32(end, true) !== 0x06054b50) end -= 1;
  if (end < 0) throw new Error("this is no zip file, and so no .npz");
  const count = view.getUint16(end + 10, true);
  let at = view.getUint32(end + 16, true);
  const arrays = {};
  for (let i = 0; i < count; i++) {
    if (at + 46 > bytes.length || view.getUint32(at, true) !== 0x02014b50)
      throw new Error("the zip directory is damaged");
    const method = view.getUint16(at + 10, true);
    let [packed, size] = [view.getUint32(at + 20, true), view.getUint32(at + 24, true)];
    const [nameLength, extra, comment] = [28, 30, 32].map((k) => view.getUint16(at + k, true));
    const name = new TextDecoder().decode(bytes.subarray(at + 46, at + 46 + nameLength));
    let local = view.getUint32(at + 42, true);
    // Zip64 keeps 64-bit sizes in an extra field.
    for (let k = at + 46 + nameLength; k + 4 <= at + 46 + nameLength + extra; k += 4 + view.getUint16(k + 2, true)) {
      if (view.getUint16(k, true) !== 1) continue;
      let field = k + 4;
      const wide = () => Number(view.getBigUint64((field += 8) - 8, true));
      if (size === 0xffffffff) size = wide();
      if (packed === 0xffffffff) packed = wide();
      if (local === 0xffffffff) local = wide();
    }
    const start = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
    if (start + packed > bytes.length) throw new Error(`${name} is cut off`);
    let data = bytes.subarray(start, start + packed);
    if (method === 8) {
      const stream = new Blob([data]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
      data = new Uint8Array(await new Response(stream).arrayBuffer());
    } else if (method !== 0) throw new Error(`${name} is compressed in a way (${method}) that is not read here`);
    if (data.length !== size) throw new Error(`${name} has ${data.length} bytes, its directory says ${size}`);
    if (name.endsWith(".npy")) arrays[name.slice(0, -4)] = readNpy(name, data);
    at += 46 + nameLength + extra + comment;
  }
  return arrays;
}

function readNpy(name, bytes) {
  if (bytes.length < 12 || bytes[0] !== 0x93 || bytes[1] !== 0x4e) throw new Error(`${name} is no .npy array`);
  const wide = bytes[6] >= 2;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const start = (wide ? 12 : 10) + (wide ? view.getUint32(8, true) : view.getUint16(8, true));
  const header = new TextDecoder("latin1").decode(bytes.subarray(wide ? 12 : 10, start));
  const type = /'descr':\s*'([^']+)'/.exec(header)?.[1];
  const shape = (/'shape':\s*\(([^)]*)\)/.exec(header)?.[1] ?? "")
    .split(",")
    .map((s) => s.trim())
    .filter(Boolean)
    .map(Number);
  if (/'fortran_order':\s*True/.test(header)) throw new Error(`${name} is in Fortran order; save it in C order`);
  const Type = TYPES[type];
  if (!Type) throw new Error(`${name} holds ${type}, which is not read here`);
  const length = shape.reduce((product, n) => product * n, 1);
  if (bytes.length - start < length * Type.BYTES_PER_ELEMENT)
    throw new Error(`${name} is shorter than its shape ${shape} says`);
  return { data: new Type(bytes.slice(start, start + length * Type.BYTES_PER_ELEMENT).buffer), shape };
}
