// A run-time compiler for the driver without a card: it sees that the texts are there and makes an
// image that says so, and which version made it. UMOV_FAKE_COMPILE: its code; UMOV_FAKE_OLDEST: the
// least capability (75); UMOV_FAKE_VERSION: 1000 major + 10 minor (UMOV_BUILT_VERSION).

#include <cstdlib>
#include <cstring>
#include <string>

namespace {

int asked(const char *name, int otherwise) {
  const char *value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : std::atoi(value);
}
const std::string complaint = "made to fail by UMOV_FAKE_COMPILE";

int version() { return asked("UMOV_FAKE_VERSION", UMOV_BUILT_VERSION); }
std::string image() { return "kernels on paper " + std::to_string(version()); }

int put_size(const std::string &text, std::size_t *size) {
  *size = text.size();
  return 0;
}
int put(const std::string &text, char *to) {
  std::memcpy(to, text.data(), text.size());
  return 0;
}

} // namespace

extern "C" {

int nvrtcVersion(int *major, int *minor) {
  *major = version() / 1000;
  *minor = version() % 1000 / 10;
  return 0;
}
int nvrtcGetNumSupportedArchs(int *count) {
  *count = 2;
  return 0;
}
int nvrtcGetSupportedArchs(int *values) {
  values[0] = asked("UMOV_FAKE_OLDEST", 75);
  values[1] = 90;
  return 0;
}
int nvrtcCreateProgram(void **program, const char *text, const char *, int count,
                       const char *const *headers, const char *const *names) {
  static int programs;
  *program = &programs;
  bool is_whole = std::strstr(text, "umov_sum_poses") != nullptr;
  for (int k = 0; k < count; ++k)
    is_whole = is_whole && headers[k][0] != '\0' && names[k][0] != '\0';
  return is_whole ? 0 : 3;
}
int nvrtcDestroyProgram(void **) { return 0; }
int nvrtcCompileProgram(void *, int, const char *const *) { return asked("UMOV_FAKE_COMPILE", 0); }
int nvrtcGetProgramLogSize(void *, std::size_t *size) { return put_size(complaint, size); }
int nvrtcGetProgramLog(void *, char *text) { return put(complaint, text); }
int nvrtcGetCUBINSize(void *, std::size_t *size) { return put_size(image(), size); }
int nvrtcGetCUBIN(void *, char *bytes) { return put(image(), bytes); }
int nvrtcGetPTXSize(void *, std::size_t *size) { return put_size(image(), size); }
int nvrtcGetPTX(void *, char *bytes) { return put(image(), bytes); }

} // extern "C"
