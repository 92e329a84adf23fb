#include <umov/inverse/parameter.h>

#include <cmath>
#include <limits>

namespace umov {

double log_prior(const Parameter &parameter, double value) {
  if (!(value >= parameter.lower && value <= parameter.upper))
    return -std::numeric_limits<double>::infinity();
  switch (parameter.prior) {
  case Prior::LogFlat:
    return -std::log(value);
  case Prior::Normal: {
    const double x = (value - parameter.mean) / parameter.sd;
    return -0.5 * x * x;
  }
  case Prior::Flat:
    break;
  }
  return 0;
}

const char *name_of(Prior prior) {
  switch (prior) {
  case Prior::LogFlat:
    return "log-flat";
  case Prior::Normal:
    return "normal";
  case Prior::Flat:
    break;
  }
  return "flat";
}

} // namespace umov
