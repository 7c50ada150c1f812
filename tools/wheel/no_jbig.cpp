// SPDX-License-Identifier: Apache-2.0
//
// Stands in for libjbig in a wheel. libtiff wants that library to be there for one of its ways to
// compress pages of one bit, and it is under the GPL, under which the wheel would be too. Pages of
// one bit are refused before they are decompressed, and nothing is written with JBIG, so that
// nothing is lost.

extern "C" {

void jbg_dec_init(void*) {}
void jbg_dec_free(void*) {}

// Returns a number that is not 0, which means success.
int jbg_dec_in(void*, unsigned char*, unsigned long, unsigned long*) {
  return 0x40;
}

const char* jbg_strerror(int) {
  return "wheels of Pellucid have no JBIG, for its licence";
}

int jbg_newlen(unsigned char*, unsigned long) {
  return 0;
}
unsigned long jbg_dec_getsize(const void*) {
  return 0;
}
unsigned char* jbg_dec_getimage(const void*, int) {
  return nullptr;
}

void jbg_enc_init(void*, unsigned long, unsigned long, int, unsigned char**, void*, void*) {}
void jbg_enc_out(void*) {}
void jbg_enc_free(void*) {}

}  // extern "C"
