// In sanitizer builds only. A GL driver that is unloaded can no longer be named or searched by the
// leak checker, which then reports what the driver still holds; so libraries stay loaded.
extern "C" int dlclose(void*) { return 0; }
