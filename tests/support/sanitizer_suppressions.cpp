// What sanitizers find in others' libraries, in every program of a sanitized build. (Not by an environment
// variable: a path with a space in it would be two options.)

extern "C" {

// LLVM's OpenMP runtime keeps its threads' memory to the end, graphics drivers theirs.
const char* __lsan_default_suppressions();
const char* __lsan_default_suppressions() {
  return "leak:libomp.so\nleak:libOSMesa.so\nleak:libEGL.so\nleak:libEGL_mesa.so\nleak:libgallium\n"
         "leak:swrast_dri.so\nleak:libLLVM\nleak:libGLdispatch.so\n";
}

// Mesa's own threads, of a driver that is not compiled with the sanitizer.
const char* __tsan_default_suppressions();
const char* __tsan_default_suppressions() {
  return "race:libOSMesa.so\nrace:libgallium\nrace:swrast_dri.so\n";
}
}
