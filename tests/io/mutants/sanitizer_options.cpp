// SPDX-License-Identifier: Apache-2.0
//
// What the address sanitizer passes over. ITK 5.2 does not free what its NRRD reader holds where it
// throws (NrrdImageIO::Read says so itself). VTK 9.1's readers do not free all that they
// made of a damaged file, and ask for as much memory as it says, whose refusal they take well.
#if defined(__SANITIZE_ADDRESS__)
#define PELLUCID_LEAK_CHECK
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PELLUCID_LEAK_CHECK
#endif
#endif

#ifdef PELLUCID_LEAK_CHECK
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() {
  return "allocator_may_return_null=1";
}
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libITKNrrdIO\nleak:libITKIONRRD\nleak:libvtk\n";
}
#endif
