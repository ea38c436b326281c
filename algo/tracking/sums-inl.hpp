// Small vectors of lanes and the sums of normal equations, for the kernels of the residual terms. Included
// once per target, inside of their namespaces.
#if defined(ST_TRACKING_SUMS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef ST_TRACKING_SUMS_INL
#undef ST_TRACKING_SUMS_INL
#else
#define ST_TRACKING_SUMS_INL
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace st {
namespace HWY_NAMESPACE {
namespace sums {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
using DI = hn::RebindToSigned<D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;
using M = hn::Mask<D>;

constexpr int kBlock = 512;  // points between two emptyings of the float sums into double ones

template <class W>
struct VecOf {
  W x, y, z;
};
using Vec = VecOf<V>;

HWY_INLINE Vec turned(D d, const float* R, const Vec& p) {
  const auto row = [&](int r) {
    return hn::MulAdd(hn::Set(d, R[3 * r]), p.x,
                      hn::MulAdd(hn::Set(d, R[3 * r + 1]), p.y, hn::Mul(hn::Set(d, R[3 * r + 2]), p.z)));
  };
  return {row(0), row(1), row(2)};
}

// R p + t.
HWY_INLINE Vec moved(D d, const float* R, const float* t, const Vec& p) {
  const Vec q = turned(d, R, p);
  return {hn::Add(q.x, hn::Set(d, t[0])), hn::Add(q.y, hn::Set(d, t[1])), hn::Add(q.z, hn::Set(d, t[2]))};
}

// R^T p.
HWY_INLINE Vec turned_back(D d, const float* R, const Vec& p) {
  const auto column = [&](int c) {
    return hn::MulAdd(hn::Set(d, R[c]), p.x,
                      hn::MulAdd(hn::Set(d, R[3 + c]), p.y, hn::Mul(hn::Set(d, R[6 + c]), p.z)));
  };
  return {column(0), column(1), column(2)};
}

template <class W>
HWY_INLINE VecOf<W> crossed(const VecOf<W>& a, const VecOf<W>& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

template <class E>
HWY_INLINE double sum(E d, hn::Vec<E> v) {
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(d, v)));
}

// Sums of w J J^T (upper triangle, row by row) and w J r, for vectors of any width.
template <class E, int N>
struct SumsOf {
  using V = hn::Vec<E>;
  static constexpr int kTriangle = N * (N + 1) / 2;
  V h[kTriangle], g[N];

  HWY_INLINE void clear(E d) {
    for (V& v : h) v = hn::Zero(d);
    for (V& v : g) v = hn::Zero(d);
  }
  HWY_INLINE void add(const V (&J)[N], V r, V w) {
    int k = 0;
    for (int i = 0; i < N; ++i) {
      const V wJ = hn::Mul(w, J[i]);
      g[i] = hn::MulAdd(wJ, r, g[i]);
      for (int j = i; j < N; ++j, ++k) h[k] = hn::MulAdd(wJ, J[j], h[k]);
    }
  }
  HWY_INLINE void empty_into(E d, double* triangle, double* gradient) {
    for (int i = 0; i < kTriangle; ++i) triangle[i] += sum(d, h[i]);
    for (int i = 0; i < N; ++i) gradient[i] += sum(d, g[i]);
    clear(d);
  }
};
template <int N>
using Sums = SumsOf<D, N>;

}  // namespace sums
}  // namespace HWY_NAMESPACE
}  // namespace st
HWY_AFTER_NAMESPACE();
#endif
