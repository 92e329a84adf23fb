#include <umov/core/stop.h>

#include <cstdlib>

namespace umov {

void leave_stopped() {
#ifdef __cpp_exceptions
  throw Failure(Error{ErrorCode::Interrupted, "stopped by the user", {}});
#else
  std::abort();
#endif
}

} // namespace umov
