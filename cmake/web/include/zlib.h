// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The functions of zlib that the sources call, done by pako, which is zlib in JavaScript
/// (cmake/web/zlib.js): Emscripten has none of its own. They mean what zlib's manual says, but that
/// `msg` stays null.
#ifdef __cplusplus
extern "C" {
#endif

typedef unsigned char Byte;
typedef Byte Bytef;
typedef unsigned int uInt;
typedef unsigned long uLong;

/// Read and written by cmake/web/zlib.js, word by word.
typedef struct z_stream_s {
  const Bytef* next_in;
  uInt avail_in;
  uLong total_in;
  Bytef* next_out;
  uInt avail_out;
  uLong total_out;
  const char* msg;
  uInt number;  ///< of pako's stream; 0: none
} z_stream;

#define Z_NO_FLUSH 0
#define Z_SYNC_FLUSH 2
#define Z_FINISH 4
#define Z_OK 0
#define Z_STREAM_END 1
#define Z_STREAM_ERROR (-2)
#define Z_DATA_ERROR (-3)
#define Z_MEM_ERROR (-4)
#define Z_BUF_ERROR (-5)
#define Z_DEFAULT_COMPRESSION (-1)
#define Z_DEFLATED 8
#define Z_DEFAULT_STRATEGY 0

int inflateInit2(z_stream* stream, int window_bits);
int inflate(z_stream* stream, int flush);
int inflateReset(z_stream* stream);
int inflateEnd(z_stream* stream);
int deflateInit2(z_stream* stream, int level, int method, int window_bits, int memory_level,
                 int strategy);
int deflate(z_stream* stream, int flush);
int deflateEnd(z_stream* stream);
uLong crc32(uLong crc, const Bytef* bytes, uInt count);

#ifdef __cplusplus
}
#endif
