#include "reduce_model.h"

#include <algorithm>
#include <umov/core/text.h>

namespace umov::cli {

Result<void> read_reduce_model(const std::string &text, jobs::ReduceOptions &out) {
  if (text == "static")
    return {};
  const auto wrong = [&] {
    return fail(ErrorCode::Usage, "--model " + text +
                                      ": static, fourier:PERIOD_S, fourier:PERIOD_S:HARMONICS or "
                                      "spline:KNOTS_S was expected");
  };
  if (text.starts_with("spline:")) {
    const auto knot = parse_number(text.substr(7));
    if (!knot || !(*knot > 0))
      return wrong();
    out.knot_s = *knot;
    return {};
  }
  if (!text.starts_with("fourier:"))
    return wrong();
  const std::string rest = text.substr(8);
  const std::size_t colon = std::min(rest.find(':'), rest.size());
  const auto period = parse_number(rest.substr(0, colon));
  if (!period || !(*period > 0))
    return wrong();
  out.period_s = *period;
  if (colon == rest.size())
    return {};
  const auto harmonics = parse_number(rest.substr(colon + 1));
  if (!harmonics || !(*harmonics >= 1 && *harmonics <= 100))
    return wrong();
  out.harmonics = static_cast<int>(*harmonics);
  return {};
}

} // namespace umov::cli
