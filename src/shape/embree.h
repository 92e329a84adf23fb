#pragma once
// Private: rays are asked of Embree 3 (Debian 12) and of Embree 4 (Debian 13, Ubuntu 24.04) in two
// ways; here they are one.

#if UMOV_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace umov::embree {

#if UMOV_EMBREE >= 4

using Order = RTCRayQueryFlags;
inline constexpr Order coherent = RTC_RAY_QUERY_FLAG_COHERENT,
                       incoherent = RTC_RAY_QUERY_FLAG_INCOHERENT;

inline void occluded(RTCScene scene, RTCRay &ray) { rtcOccluded1(scene, &ray); }
inline void occluded(RTCScene scene, const int *valid, RTCRay16 &rays, Order order) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.flags = order;
  rtcOccluded16(valid, scene, &rays, &arguments);
}
inline void intersect(RTCScene scene, RTCRayHit &ray) { rtcIntersect1(scene, &ray); }

#else

using Order = RTCIntersectContextFlags;
inline constexpr Order coherent = RTC_INTERSECT_CONTEXT_FLAG_COHERENT,
                       incoherent = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;

inline void occluded(RTCScene scene, RTCRay &ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}
inline void occluded(RTCScene scene, const int *valid, RTCRay16 &rays, Order order) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = order;
  rtcOccluded16(valid, scene, &context, &rays);
}
inline void intersect(RTCScene scene, RTCRayHit &ray) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &ray);
}

#endif

} // namespace umov::embree
