#pragma once
#include <string>
#include <vector>

namespace umov {

/// One channel of a picture: 32-bit floats, rows from the top.
struct PictureChannel {
  std::string name;
  std::vector<float> values;
};

} // namespace umov
