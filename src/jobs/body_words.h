#pragma once
// Private: what attitudes are of, in words by which a later job knows its body again.

#include <optional>
#include <string>
#include <umov/scene/scene.h>

namespace umov::jobs {

/// A body in words that are the same for the same body.
struct BodyWords {
  std::string mesh;      ///< "120 facets, 3.41 m across, sha256 1a2b3c4d5e6f"
  std::string materials; ///< "bus=mli_kapton 1a2b3c4d; panel=cell_gaas 5e6f7a8b/paint_black ..."
};
BodyWords body_words(const Scene &scene);
/// How one body differs from another; nothing if it is the same. `there` and `here` are the places
/// that the message names.
std::optional<std::string> difference_of(const BodyWords &there_has, const BodyWords &here_has,
                                         const std::string &there, const std::string &here);

} // namespace umov::jobs
