// SPDX-License-Identifier: Apache-2.0

// ITK 5.2 does not free what its NRRD reader holds where it throws (NrrdImageIO::Read says so
// itself). This is all of ITK's that the leak check passes over.
#if defined(__SANITIZE_ADDRESS__)
#define PELLUCID_LEAK_CHECK
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PELLUCID_LEAK_CHECK
#endif
#endif

#ifdef PELLUCID_LEAK_CHECK
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libITKNrrdIO\nleak:libITKIONRRD\n";
}
#endif
