// The loader unloads the software driver and the validation layer before the process ends, so LeakSanitizer can name no
// module for what those keep, and no suppression fits. Our own Vulkan handles are watched by validation instead.
#ifdef __SANITIZE_ADDRESS__
extern "C" const char* __asan_default_options();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __asan_default_options() {
    return "detect_leaks=0";
}  // NOLINT(bugprone-reserved-identifier)
#endif
