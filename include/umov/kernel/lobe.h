#pragma once
// Sorts of microfacet lobes that the kernels know.

#include <cstdint>

namespace umov {

/// Distributions of normals with a form in src/kernel/facet.inl.h.
enum class LobeKind : std::uint8_t { BlinnPhong, Beckmann, Ggx };

/// Combination of the masking of both directions (src/kernel/microfacet.inl.h).
enum class Shadowing : std::uint8_t { Ashikhmin, Smith, SmithDirectional, Separable };

} // namespace umov
