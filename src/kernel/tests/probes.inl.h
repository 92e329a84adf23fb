// One call of every kernel, for any number type: the contract's test compares what types give. T is
// the scalar that constants are stored in. Inputs are 1/64ths, the same in every type.
#if defined(UMOV_KERNEL_PROBES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef UMOV_KERNEL_PROBES_INL_H
#undef UMOV_KERNEL_PROBES_INL_H
#else
#define UMOV_KERNEL_PROBES_INL_H
#endif

#include "kernel/angles.inl.h"
#include "kernel/body.inl.h"
#include "kernel/chain_end.inl.h"
#include "kernel/facet.inl.h"
#include "kernel/films.inl.h"
#include "kernel/fresnel.inl.h"
#include "kernel/microfacet.inl.h"
#include "kernel/solar_nodes.inl.h"

#include "kernel/begin.h"

/// Calls put(value) for each of the results; x lies in (0, 1), away from every kink.
template <class R, class Put> UMOV_KERNEL void probe_math(R x, const Put &put) {
  put(power(x, R(7)));
  put(log2_of_one_minus(x));
  put(exp2(R(-3) * x));
  put(inverse_sqrt(x));
  put(clamped(R(3) * x, R(-1), R(4)));
  const R c[3] = {R(1), R(-2), R(0.5)};
  put(polynomial(c, 2, x));
  put(select(x > R(2), x, R(1) - x));
}

template <class R, class Put> UMOV_KERNEL void probe_angles(R x, const Put &put) {
  const SineCosine<R> wave = sine_cosine(R(9) * x);
  put(wave.sine);
  put(wave.cosine);
  put(arc_tangent(x, R(-0.3)));
  put(arc_tangent(-x, x * x));
  put(within_turn(R(7) * x + R(7)));
  put(rest_of_turn(R(6) * x + R(7)));
}

template <class R, class Put>
UMOV_KERNEL void probe_reflection(const Reflection<R> &r, const Put &put) {
  put(r.a);
  put(r.b);
  put(r.z.re);
  put(r.z.im);
}
template <class R, class Put> UMOV_KERNEL void probe_fresnel(R x, const Put &put) {
  probe_reflection(reflection(fresnel(x, Complex<R>{R(1.5), R(0)})), put);
  probe_reflection(reflection(fresnel(x, Complex<R>{R(0.75), R(4)})), put);
  probe_reflection(reflection(fresnel(x, Complex<R>{R(1), R(0)})), put); // no interface
}

template <class R, class Put> UMOV_KERNEL void probe_films(R x, const Put &put) {
  const Complex<R> air{R(1), R(0)}, glass{R(1.5), R(0)}, metal{R(1.25), R(6)};
  const Film<R> films[2] = {{{R(1.375), R(0)}, R(0.25)}, {{R(2.25), R(0.125)}, R(0.5)}};
  const StackAmplitudes<R> down = stack(air, R(1) - x * x, films, 2, glass);
  const StackAmplitudes<R> below = stack(glass, R(1) - x * x, films, 1, metal);
  const Powers<R> top = powers(down.r), through = powers(down.t, down.power_s, down.power_p);
  probe_reflection(reflection(top), put);
  probe_reflection(reflection(thick_layer(top, through, through, top, R(0.75), powers(below.r))),
                   put);
}

template <class R, class Put> UMOV_KERNEL void probe_body(R x, const Put &put) {
  const R z = sqrt(R(1) - x * x);
  const EmissionPlanes<R> planes = emission_planes(x, R(0), z, R(0.28), R(0.75), R(0.6));
  put(planes.cos_in);
  put(planes.sin_in);
  put(planes.cos_out);
  put(planes.sin_out);
}

template <class R, class Put> UMOV_KERNEL void probe_microfacet(R x, const Put &put) {
  put(blinn_phong(x, R(12)));
  const Spread<R> by = blinn_phong_spread(R(12), x, R(0.5) * x);
  put(by.scale);
  put(by.along);
  put(by.across);
  put(beckmann(x, R(0.5)));
  put(beckmann_masking(x, R(0.5)));
  put(beckmann_beyond(x, R(0.5)));
  put(beckmann_beyond(x, R(0.0625)));
  put(ggx(x, R(0.5)));
  put(ggx_masking(x, R(0.5)));
  put(ggx_beyond(x, R(0.5)));
  put(ggx_beyond(x, R(2)));
  put(ashikhmin_shirley(x, R(0.5) * (R(1) - x * x), R(0.25), R(10), R(40)));
  const R v[4] = {R(1), x, R(0.5), R(2)};
  put(cubic(v, x));
  put(mean_cosine(R(10) * x));
  put(half_cosine(x, R(0.5), R(0.25)));
  for (const Shadowing joint :
       {Shadowing::Ashikhmin, Shadowing::Smith, Shadowing::SmithDirectional, Shadowing::Separable})
    put(joint_masking(joint, x, R(0.7), R(0.75) * x, R(0.5), R(0.25)));
}

template <class R> struct ProbeVector { R x, y, z; };
template <class R>
UMOV_KERNEL ProbeVector<R> operator+(const ProbeVector<R> &a, const ProbeVector<R> &b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R> UMOV_KERNEL ProbeVector<R> operator*(R s, const ProbeVector<R> &a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class R, class Put> UMOV_KERNEL void probe_solar_nodes(R x, const Put &put) {
  const DiskVariances<R> kappa = disk_variances(R(0.125), x);
  put(kappa.along);
  put(kappa.across);
  const ProbeVector<R> e1{R(1), R(0), R(0)}, e2{R(0), R(1), R(0)}, l{R(0), R(0), R(1)};
  const ProbeVector<R> at = disk_direction(l, e1, e2, R(0.125), x, R(0.6), R(0.8));
  put(at.x);
  put(at.y);
  put(at.z);
  put(source_node_weight<R>(0));
  put(source_node_weight<R>(6));
}

/// Sun and observer in the x z plane, 0.6 and -0.6 from the normal of the plane, and a facet that
/// leans by x from it.
template <class R, class T, class Put> UMOV_KERNEL void probe_facet(R x, const Put &put) {
  FacetPose<T> pose;
  const T sun[3] = {T(0.6), T(0), T(0.8)};
  for (std::size_t k = 0; k < 3; ++k) {
    pose.sun[k] = sun[k];
    pose.observer[k] = k == 0 ? -sun[k] : sun[k];
  }
  pose.cos_phase = T(0.28);
  pose.along_scale = T(1 / 1.2);
  pose.half[2] = T(1);
  pose.half_shift = T(-0.001);
  const R nx = R(0.3) * x, ny = R(0.2) * x, nz = sqrt(R(1) - nx * nx - ny * ny);
  const R n_l = nx * R(pose.sun[0]) + nz * R(pose.sun[2]),
          n_v = nx * R(pose.observer[0]) + nz * R(pose.observer[2]);
  LobeConstants<T> lobe;
  lobe.masking[0] = T(1.5);
  lobe.masking[1] = T(-0.25);
  for (const LobeKind kind : {LobeKind::BlinnPhong, LobeKind::Beckmann, LobeKind::Ggx})
    for (const Shadowing joint : {Shadowing::Ashikhmin, Shadowing::SmithDirectional}) {
      lobe.kind = kind;
      lobe.joint = joint;
      lobe.shape = kind == LobeKind::BlinnPhong ? T(40) : T(0.25);
      lobe.peak = T(6.5);
      LobeAtPose<T> at;
      at.peak = T(6);
      at.along = kind == LobeKind::Ggx ? T(0.01) : kind == LobeKind::Beckmann ? T(-11) : T(0.5);
      at.across = kind == LobeKind::Ggx ? T(0.02) : kind == LobeKind::Beckmann ? T(-10) : T(0.25);
      put(lobe_weight(lobe, at, pose, apart_from_half(pose, nx, ny, nz), n_l, n_v));
      at.is_corrected = true;
      at.correction = {T(30),    T(25),    T(0.99), T(-0.01), T(-0.02),  T(0.002),
                       T(0.003), T(0.004), T(1e-4), T(2e-4),  T(1.5e-4), T(3e-4)};
      put(lobe_weight(lobe, at, pose, apart_from_half(pose, nx, ny, nz), n_l, n_v));
      at.uses_chords = true;
      at.chords = {T(5), T(2), T(0.5), T(0.75), T(0.02), T(0.03)};
      put(lobe_weight(lobe, at, pose, apart_from_half(pose, nx, ny, nz), n_l, n_v));
    }
}

/// A surface at an end of a chain: a lobe and two products, one polarized as a reflection is.
struct ProbeChainSurface {
  struct Product {
    float bend = 0.5f, factor = 0.25f;
    std::uint32_t degree = polynomial_degree;
    bool is_as_reflected = false, is_polarized = false;
    float profile[polynomial_degree + 1] = {0.75f, 0.125f, -0.0625f};
    float polarizing[polynomial_degree + 1] = {0.125f, 0.25f};
  };
  float bend = 0.25f;
  std::uint32_t degree = polynomial_degree;
  float a[polynomial_degree + 1] = {0.75f, -0.125f}, b[polynomial_degree + 1] = {0.125f, 0.25f},
                              z_real[polynomial_degree + 1] = {-0.5f},
                              z_imaginary[polynomial_degree + 1] = {0.25f, 0.125f};
  bool has_lobe = true;
  std::uint32_t products = 2;
  Product product[2];
};
template <class R, class Put> UMOV_KERNEL void probe_beam(const Beam<R> &beam, const Put &put) {
  put(beam.i);
  put(beam.q);
  put(beam.u);
  put(beam.v);
}
/// What lies between the ends of a chain that is taken from behind.
template <class R> struct ProbeBetween {
  R x;
  UMOV_KERNEL R operator()(std::uint32_t row, std::uint32_t column) const {
    return x * R(0.125f * static_cast<float>(1 + row)) - R(0.25f * static_cast<float>(column));
  }
  UMOV_KERNEL Beam<R> operator()(LinearBeam<R> light) const {
    return chain_between(*this, true, light);
  }
};
/// Sun and observer on both sides of the normal, a chain that leans by x from it.
template <class R, class T, class Put> UMOV_KERNEL void probe_chain_end(R x, const Put &put) {
  const Triple<R> normal{R(0), R(0), R(1)}, sun{R(0.6), R(0), R(0.8)},
      seen{R(-0.48), R(0.36), R(0.8)};
  const R lean = R(0.5) * x, side = R(0.25) * x;
  const Triple<R> along{lean, side, sqrt(R(1) - lean * lean - side * side)};
  const Triple<R> axis = outer(along, Triple<R>{R(0), R(1), R(0)}), plane = outer(seen, sun);
  ProbeChainSurface surface;
  surface.product[0].is_as_reflected = true;
  surface.product[1].is_polarized = true;
  LobeConstants<T> lobe;
  lobe.masking[0] = T(1.5);
  lobe.masking[1] = T(-0.25);
  for (const LobeKind kind : {LobeKind::BlinnPhong, LobeKind::Beckmann, LobeKind::Ggx}) {
    lobe.kind = kind;
    lobe.shape = kind == LobeKind::BlinnPhong ? T(40) : T(0.25);
    lobe.peak = T(6.5);
    const auto in = chain_end_at(normal, along, sun), out = chain_end_at(normal, along, seen);
    const auto entered =
        chain_entered(surface, chain_lobe(lobe, in), in, turn_at_end(along, axis, sun));
    const BeamTurn<R> none{R(1), R(0)};
    probe_beam(turned(entered.whole, none), put);
    probe_beam(turned(entered.lobe, none), put);
    const PoseAxes<R> pose = pose_axes(sun, seen, plane);
    probe_beam(chain_left(surface, chain_lobe(lobe, out), out,
                          turns_at_observer(normal, along, axis, pose, true),
                          turned(entered.whole, none), turned(entered.lobe, none)),
               put);
    const ChainEndAxes<R> end{normal, along, axis};
    const auto whole = chain_at(end, end, out, in, pose, true, true);
    probe_beam(turned(entered.whole, whole.straight), put);
    probe_beam(chain_carried(surface, surface, chain_lobe(lobe, out), chain_lobe(lobe, in), whole,
                             true, ProbeBetween<R>{x}),
               put);
  }
}

/// Families of kernels, and how far a type of single precision may be from double, of the value
/// plus one.
inline constexpr std::size_t probe_families = 9;
struct ProbeFamily {
  const char *name;
  double single;
};
inline ProbeFamily probe_family(std::size_t family) {
  constexpr ProbeFamily all[probe_families] = {
      {"math", 2e-6},        {"angles", 2e-6}, {"fresnel", 3e-6},
      {"films", 3e-5},       {"body", 1e-5},   {"microfacet", 2e-4},
      {"solar_nodes", 1e-6}, {"facet", 1e-4},  {"chain_end", 1e-4}};
  return all[family];
}
template <class R, class T, class Put>
UMOV_KERNEL void probe(std::size_t family, R x, const Put &put) {
  switch (family) {
  case 0:
    return probe_math(x, put);
  case 1:
    return probe_angles(x, put);
  case 2:
    return probe_fresnel(x, put);
  case 3:
    return probe_films(x, put);
  case 4:
    return probe_body(x, put);
  case 5:
    return probe_microfacet(x, put);
  case 6:
    return probe_solar_nodes(x, put);
  case 7:
    return probe_facet<R, T>(x, put);
  default:
    return probe_chain_end<R, T>(x, put);
  }
}

#include "kernel/end.h"
#endif
