// SPDX-License-Identifier: Apache-2.0
//
// What cmake/web/include/zlib.h declares, by pako: `pakoModules` comes before this in the module
// (apps/web/join_pako.py), and its streams read and write the module's memory itself.
mergeInto(LibraryManager.library, {
  $zlibStreams__deps: [],
  $zlibStreams: {
    list: [null],
    /** Makes a stream, whose number is kept in the module's struct. */
    open: function(at, begin) {
      const stream = new pakoModules.zstream();
      const status = begin(stream);
      if (status !== 0) return status;
      let number = zlibStreams.list.indexOf(null, 1);
      if (number < 0) number = zlibStreams.list.length;
      zlibStreams.list[number] = stream;
      HEAPU32[(at >> 2) + 6] = 0;
      HEAPU32[(at >> 2) + 7] = number;
      return 0;
    },
    /** Lets a stream work on the bytes that the struct names, and writes down how far it came. */
    run: function(at, work) {
      const words = at >> 2;
      const stream = zlibStreams.list[HEAPU32[words + 7]];
      if (!stream) return -2;
      stream.input = stream.output = HEAPU8;
      stream.next_in = HEAPU32[words];
      stream.avail_in = HEAPU32[words + 1];
      stream.next_out = HEAPU32[words + 3];
      stream.avail_out = HEAPU32[words + 4];
      const status = work(stream);
      HEAPU32[words] = stream.next_in;
      HEAPU32[words + 1] = stream.avail_in;
      HEAPU32[words + 2] = stream.total_in;
      HEAPU32[words + 3] = stream.next_out;
      HEAPU32[words + 4] = stream.avail_out;
      HEAPU32[words + 5] = stream.total_out;
      stream.input = stream.output = null;
      return status;
    },
    close: function(at) {
      const number = HEAPU32[(at >> 2) + 7];
      if (number !== 0) zlibStreams.list[number] = null;
      HEAPU32[(at >> 2) + 7] = 0;
      return 0;
    },
  },
  inflateInit2__deps: ['$zlibStreams'],
  inflateInit2: function(at, bits) {
    return zlibStreams.open(at, (stream) => pakoModules.inflate.inflateInit2(stream, bits));
  },
  inflate__deps: ['$zlibStreams'],
  inflate: function(at, flush) {
    return zlibStreams.run(at, (stream) => pakoModules.inflate.inflate(stream, flush));
  },
  inflateReset__deps: ['$zlibStreams'],
  inflateReset: function(at) {
    return zlibStreams.run(at, (stream) => pakoModules.inflate.inflateReset(stream));
  },
  inflateEnd__deps: ['$zlibStreams'],
  inflateEnd: function(at) {
    return zlibStreams.close(at);
  },
  deflateInit2__deps: ['$zlibStreams'],
  deflateInit2: function(at, level, method, bits, memory, strategy) {
    return zlibStreams.open(at, (stream) =>
      pakoModules.deflate.deflateInit2(stream, level, method, bits, memory, strategy));
  },
  deflate__deps: ['$zlibStreams'],
  deflate: function(at, flush) {
    return zlibStreams.run(at, (stream) => pakoModules.deflate.deflate(stream, flush));
  },
  deflateEnd__deps: ['$zlibStreams'],
  deflateEnd: function(at) {
    return zlibStreams.close(at);
  },
  crc32: function(crc, bytes, count) {
    return (bytes === 0 ? 0 : pakoModules.crc32(crc, HEAPU8, count, bytes) >>> 0);
  },
});
