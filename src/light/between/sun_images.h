#pragma once
// The Sun as narrow lobes show it: where a path on a wide surface has to go for the next one to
// send sunlight back to it.

#include "light/between/mirror_parts.h"

#include <span>

namespace umov {

/// The images of one Sun, and how likely each is taken from a point.
class SunImages {
public:
  /// What a point sees: sums of chances up to and with each image.
  struct Choice {
    std::vector<float> end;
    [[nodiscard]] bool is_empty() const { return end.empty() || !(end.back() > 0); }
  };
  struct Drawn {
    std::uint32_t part = MirrorParts::none; ///< the one that the direction is meant for
    Vec3<Body> to{};
    double density = 0; ///< [1/sr] of this part and direction; 0: none
  };

  /// `parts` must live; null: there are no images.
  SunImages(const MirrorParts *parts, Vec3<Body> sun);

  [[nodiscard]] bool is_empty() const { return part_.empty(); }
  void look_from(Vec3<Body> point, Choice &out) const;
  /// Three even numbers in [0, 1).
  [[nodiscard]] Drawn draw(const Choice &choice, double x, double u, double v) const;
  /// [1/sr]: how likely `draw` takes this part and this direction.
  [[nodiscard]] double density(const Choice &choice, std::uint32_t part, Vec3<Body> to) const;

private:
  [[nodiscard]] double lobe(const MirrorPart &part, Vec3<Body> to) const;

  /// Side by side, since each point looks at all of them. A line from a point p towards an image
  /// meets the part's plane after (level - n.p) `per_step`.
  struct Lanes {
    std::vector<float> normal[3], along[3], across[3];
    std::vector<float> level, per_step;
    std::vector<float> along_step, across_step; ///< of the image's direction
    std::vector<float> along_centre, across_centre, half_along, half_across;
    std::vector<float> spread; ///< beside the part, per length of the way [rad]
    std::vector<float> least_way;
  };

  std::span<const MirrorPart> parts_;
  Vec3<Body> sun_;
  std::vector<std::uint32_t> part_, image_; ///< of each image its part, and the reverse
  Lanes lanes_;
};

} // namespace umov
