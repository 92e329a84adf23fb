// Closes what kernel/begin.h opened.
} // namespace
#ifdef HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
