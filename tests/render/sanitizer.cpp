// Read by LeakSanitizer where it is built in: the same as lsan.supp, without an environment variable.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\nleak:libEGL.so\nleak:libEGL_mesa.so\nleak:libgallium\nleak:swrast_dri.so\nleak:"
         "libLLVM\n"
         "leak:libGLdispatch.so\n";
}
