// Point-to-plane residuals with a depth sensor's noise, for vectors of any width: which pairs are taken for
// the same surface, and what each is worth. Included once per target, inside of their namespaces.
#if defined(ST_TRACKING_POINT_PLANE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_TRACKING_POINT_PLANE_INL
#undef ST_TRACKING_POINT_PLANE_INL
#else
#define ST_TRACKING_POINT_PLANE_INL
#endif

#include <hwy/highway.h>

#include "algo/tracking/model_view.hpp"

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace point_plane {
namespace hn = hwy::HWY_NAMESPACE;

// depth_sigma_m().
template <class E>
HWY_INLINE hn::Vec<E> axial_sigma(E d, hn::Vec<E> z) {
  return hn::MulAdd(hn::Mul(z, z), hn::Set(d, kDepthSigmaPerSquare), hn::Set(d, kLeastDepthSigma_m));
}

// Points no farther apart than a gate (squared, m^2) that noise widens.
template <class E>
HWY_INLINE hn::Mask<E> in_reach(E d, hn::Vec<E> distance2, hn::Vec<E> sigma, float gate2) {
  return hn::Le(distance2, hn::MulAdd(hn::Mul(sigma, sigma), hn::Set(d, 16.0f), hn::Set(d, gate2)));
}

// The weight of a residual is keep^2 times per_variance.
template <class E>
struct Weighed {
  hn::Vec<E> r2, keep, per_variance;
  hn::Mask<E> inlier;  // within three sigma
};

// r: the residual along the normal, whose part along the camera's axis is nz, of a point at depth z. `keep`
// is the root of Tukey's biweight, zero at the squared number of sigmas `robust2`.
template <class E>
HWY_INLINE Weighed<E> weigh(E d, hn::Vec<E> r, hn::Vec<E> nz, hn::Vec<E> z, hn::Vec<E> sigma,
                            hn::Vec<E> half_pixel, float robust2, hn::Mask<E> on) {
  // Axial noise seen along the normal, plus what a pixel's width leaves open sideways.
  const auto axial = hn::Mul(sigma, nz), lateral = hn::Mul(half_pixel, z);
  const auto variance = hn::MulAdd(axial, axial, hn::Mul(lateral, lateral));
  const auto r2 = hn::Mul(r, r);
  const auto inlier = hn::And(on, hn::Lt(r2, hn::Mul(hn::Set(d, 9.0f), variance)));
  const auto per_variance = hn::Div(hn::Set(d, 1.0f), variance);
  const auto keep = hn::NegMulAdd(hn::Mul(r2, per_variance), hn::Set(d, 1.0f / robust2), hn::Set(d, 1.0f));
  return {r2, hn::Max(keep, hn::Zero(d)), per_variance, inlier};
}

}  // namespace point_plane
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
