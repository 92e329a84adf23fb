#pragma once
#include <umov/core/result.h>
#include <umov/optics/band.h>
#include <umov/shape/mesh.h>
#include <umov/surface/surface.h>
#include <vector>

namespace umov {

enum class NormalMode { Flat, Smooth };

/// One object ready to be lit: a cleaned mesh, a compiled surface for each mesh group and the bands.
struct Scene {
  Mesh mesh;
  NormalMode normals = NormalMode::Flat;
  std::vector<Band> bands;
  std::vector<Surface> front; ///< per mesh group: seen when the group is the side faced
  std::vector<Surface> back;  ///< per mesh group: where the back of that group's faces is seen
};

} // namespace umov
