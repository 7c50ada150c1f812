// SPDX-License-Identifier: Apache-2.0
import makePellucid from './pellucid.mjs';

const types = new Map([[Uint8Array, '|u1'], [Int8Array, '|i1'], [Uint16Array, '<u2'],
  [Int16Array, '<i2'], [Uint32Array, '<u4'], [Int32Array, '<i4'], [Float32Array, '<f4'],
  [Float64Array, '<f8']]);

/** An array as a file of NumPy. */
function npyFile(name, {data, shape}) {
  const type = types.get(data?.constructor);
  if (!type) throw new Error(`${name}: its data are of no type that is read`);
  const count = shape?.reduce((product, side) => product * side, 1);
  if (shape?.length !== 3 || count !== data.length) {
    throw new Error(`${name}: has ${data.length} values, but a shape of ${JSON.stringify(shape)}; ` +
      'give the sides along z, y and x');
  }
  let text = `{'descr': '${type}', 'fortran_order': False, 'shape': (${shape.join(', ')}), }`;
  text = text.padEnd(Math.ceil((text.length + 11) / 64) * 64 - 11) + '\n';
  const bytes = new Uint8Array(10 + text.length + data.byteLength);
  bytes.set([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0, text.length & 255, text.length >> 8]);
  bytes.set(new TextEncoder().encode(text), 10);
  bytes.set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), 10 + text.length);
  return bytes;
}

/** The sources of a layer's data that name arrays get the ending by which they are read. */
function withFileNames(value, names) {
  if (Array.isArray(value)) return value.map((one) => withFileNames(one, names));
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.entries(value).map(([key, one]) => (
    key === 'file' && names.has(one) ? [key, `${one}.npy`] : [key, withFileNames(one, names)])));
}

export class Pellucid {
  constructor(module) {
    this.module = module;
    this.scenes = 0;
  }

  render(scene, arrays = {}, {width = 0, height = 0, tolerance = 0} = {}) {
    const {module} = this;
    const {FS} = module;
    if ((width > 0) !== (height > 0)) throw new Error('give both width and height, or none');
    const folder = `/render${++this.scenes}`;
    FS.mkdir(folder);
    const written = [];
    const write = (name, bytes) => {
      if (name.includes('/') || name === '') throw new Error(`${name}: is no plain name`);
      FS.writeFile(`${folder}/${name}`, bytes, {canOwn: true});
      written.push(name);
    };
    try {
      const names = new Set();
      for (const [name, array] of Object.entries(arrays)) {
        const isFile = array instanceof Uint8Array;
        if (!isFile) names.add(name);
        write(isFile ? name : `${name}.npy`, isFile ? array.slice() : npyFile(name, array));
      }
      write('scene.json', new TextEncoder().encode(JSON.stringify(withFileNames(scene, names))));
      const done = module.ccall('pellucid_render', 'number',
        ['string', 'number', 'number', 'number'],
        [`${folder}/scene.json`, width, height, tolerance]);
      const text = module.ccall('pellucid_text', 'string', [], []);
      if (!done) throw new Error(text.replaceAll(`${folder}/`, ''));
      return this.picture(JSON.parse(text));
    } finally {
      for (const name of written) FS.unlink(`${folder}/${name}`);
      FS.rmdir(folder);
    }
  }

  picture(camera) {
    const {module} = this;
    const width = module._pellucid_width(), height = module._pellucid_height();
    // Copies: the module's memory changes with the next frame.
    const numbers = (at, count) => module.HEAPF32.slice(at >> 2, (at >> 2) + count);
    const errors = module._pellucid_errors();
    return {
      width, height, camera,
      rgba: numbers(module._pellucid_pixels(), 4 * width * height),
      error: errors === 0 ? null : numbers(errors, width * height),
      largestError: module._pellucid_largest_error(),
      pixelsOver: module._pellucid_pixels_over(),
      seconds: module._pellucid_seconds(),
    };
  }
}

async function ownModule() {
  const address = new URL('pellucid.wasm', import.meta.url);
  if (address.protocol === 'file:' && typeof process === 'object') {
    const {readFile} = await import('node:fs/promises');
    return readFile(address);
  }
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: ${response.status} ${response.statusText}`);
  return new Uint8Array(await response.arrayBuffer());
}

export async function load(module = undefined) {
  const wasmBinary = module ?? await ownModule();
  if (!WebAssembly.validate(wasmBinary)) {
    throw new Error('This takes WebAssembly with SIMD and exceptions: Node 18, Chrome or Edge 97, ' +
      'Firefox 113, Safari 16.4, or later; or the module is damaged.');
  }
  return new Pellucid(await makePellucid({wasmBinary, print: () => {}, printErr: () => {}}));
}
