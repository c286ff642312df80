// SPDX-License-Identifier: Apache-2.0
#include "core/terrain/plane_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/terrain/plane_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace warren::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Floats = hn::Rebind<float, Doubles>;
using V = hn::Vec<Doubles>;

struct Symmetric {
  V xx, xy, xz, yy, yz, zz;
};
struct Eigenvalues {
  V l0, l1, l2;  // ascending
};
struct Direction {
  V x, y, z;
};

inline V add(V a, V b) { return hn::Add(a, b); }
inline V sub(V a, V b) { return hn::Sub(a, b); }
inline V mul(V a, V b) { return hn::Mul(a, b); }
inline V constant(double value) { return hn::Set(Doubles(), value); }
inline V square(V a) { return mul(a, a); }

inline Symmetric covariance(const MomentRows& moments, std::size_t i, V per_point) {
  const auto row = [&](std::size_t number) HWY_ATTR {
    return mul(hn::PromoteTo(Doubles(), hn::LoadU(Floats(), moments[number] + i)), per_point);
  };
  const V x = row(0);
  const V y = row(1);
  const V z = row(2);
  return {sub(row(3), mul(x, x)), sub(row(4), mul(x, y)), sub(row(5), mul(x, z)),
          sub(row(6), mul(y, y)), sub(row(7), mul(y, z)), sub(row(8), mul(z, z))};
}

// cos(acos(x) / 3) for x in 0..1: the root of 4c^3 - 3c = x in 0.866..1. There the slope is 6..9,
// so three of Newton's steps from a parabola are exact to the last bits.
inline V cosine_of_third(V x) {
  V c = add(constant(0.8660254037844386),
            mul(x, sub(constant(0.16666666666666666), mul(x, constant(0.03269207045110531)))));
  for (int step = 0; step < 3; ++step) {
    const V cc = mul(c, c);
    const V value = sub(mul(c, sub(mul(constant(4.0), cc), constant(3.0))), x);
    c = sub(c, hn::Div(value, sub(mul(constant(12.0), cc), constant(3.0))));
  }
  return c;
}

// O. K. Smith, "Eigenvalues of a symmetric 3 x 3 matrix", 1961. The eigenvalue that stands apart is
// exact to the last bits, the two others to half of the digits where they meet.
inline Eigenvalues eigenvalues(const Symmetric& a) {
  const V mean = mul(add(add(a.xx, a.yy), a.zz), constant(1.0 / 3.0));
  const V xx = sub(a.xx, mean);
  const V yy = sub(a.yy, mean);
  const V zz = sub(a.zz, mean);
  const V off = add(add(square(a.xy), square(a.xz)), square(a.yz));
  const V diagonal = add(add(square(xx), square(yy)), square(zz));
  const V p2 = mul(add(diagonal, add(off, off)), constant(1.0 / 6.0));
  const V p = hn::Sqrt(p2);
  const V determinant = add(
      sub(mul(xx, sub(mul(yy, zz), square(a.yz))), mul(a.xy, sub(mul(a.xy, zz), mul(a.yz, a.xz)))),
      mul(a.xz, sub(mul(a.xy, a.yz), mul(yy, a.xz))));
  // No spread at all gives 0 / tiny.
  const V cube = hn::Max(mul(p, p2), constant(1e-300));
  const V r = mul(hn::Div(determinant, cube), constant(0.5));
  const V x = hn::Min(hn::Abs(r), constant(1.0));
  const V c = cosine_of_third(x);
  const V s = mul(hn::Sqrt(hn::Max(sub(constant(1.0), square(c)), constant(0.0))),
                  constant(1.7320508075688772));
  // For r >= 0 the largest stands apart at 2c; for r < 0 all signs turn.
  const V apart = mul(p, add(c, c));
  const V close_inner = mul(p, sub(c, s));
  const V close_outer = mul(p, add(c, s));
  const auto largest_apart = hn::Ge(r, constant(0.0));
  const V l0 = sub(mean, hn::IfThenElse(largest_apart, close_outer, apart));
  const V l1 = hn::IfThenElse(largest_apart, sub(mean, close_inner), add(mean, close_inner));
  const V l2 = add(mean, hn::IfThenElse(largest_apart, apart, close_outer));
  return {l0, l1, l2};
}

inline Direction cross(const Direction& a, const Direction& b) {
  return {sub(mul(a.y, b.z), mul(a.z, b.y)), sub(mul(a.z, b.x), mul(a.x, b.z)),
          sub(mul(a.x, b.y), mul(a.y, b.x))};
}
inline V squared_length(const Direction& a) {
  return add(add(square(a.x), square(a.y)), square(a.z));
}

// Rows of A - l0 I are at right angles to the eigenvector: of their three cross products the
// longest is the most precise. Without spread in a plane it is z.
inline Direction eigenvector(const Symmetric& a, V eigenvalue) {
  const Direction row_x{sub(a.xx, eigenvalue), a.xy, a.xz};
  const Direction row_y{a.xy, sub(a.yy, eigenvalue), a.yz};
  const Direction row_z{a.xz, a.yz, sub(a.zz, eigenvalue)};
  Direction best = cross(row_x, row_y);
  V most = squared_length(best);
  for (const Direction& other : {cross(row_x, row_z), cross(row_y, row_z)}) {
    const V length = squared_length(other);
    const auto better = hn::Gt(length, most);
    best = {hn::IfThenElse(better, other.x, best.x), hn::IfThenElse(better, other.y, best.y),
            hn::IfThenElse(better, other.z, best.z)};
    most = hn::Max(most, length);
  }
  const auto exists = hn::Gt(most, constant(1e-280));
  const V scale =
      hn::IfThenElseZero(exists, hn::Div(constant(1.0), hn::Sqrt(hn::Max(most, constant(1e-280)))));
  return {mul(best.x, scale), mul(best.y, scale),
          hn::IfThenElse(exists, mul(best.z, scale), constant(1.0))};
}

void fit_plane_rows_here(const MomentRows& moments, double per_point, std::size_t points,
                         const PlaneRows& planes) {
  const Doubles d;
  const Floats f;
  const V share = hn::Set(d, per_point);
  const auto store = [&](V value, float* row, std::size_t i)
                         HWY_ATTR { hn::StoreU(hn::DemoteTo(f, value), f, row + i); };
  for (std::size_t i = 0; i < points; i += hn::Lanes(d)) {
    const Symmetric a = covariance(moments, i, share);
    const Eigenvalues l = eigenvalues(a);
    const Direction normal = eigenvector(a, l.l0);
    // Rounding may make a variance a little less than nothing; the normal is that of the raw one.
    const V zero = hn::Zero(d);
    const V l0 = hn::Max(l.l0, zero);
    const V l1 = hn::Max(l.l1, zero);
    const V l2 = hn::Max(l.l2, zero);
    const V sum = add(add(l0, l1), l2);
    store(normal.x, planes.normal_x, i);
    store(normal.y, planes.normal_y, i);
    store(normal.z, planes.normal_z, i);
    store(hn::Div(l0, hn::Max(sum, constant(1e-300))), planes.curvature, i);
    store(l0, planes.l0, i);
    store(l1, planes.l1, i);
    store(l2, planes.l2, i);
  }
}

}  // namespace warren::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace warren {

HWY_EXPORT(fit_plane_rows_here);

void fit_plane_rows(const MomentRows& moments, double per_point, std::size_t points,
                    const PlaneRows& planes) {
  HWY_DYNAMIC_DISPATCH(fit_plane_rows_here)(moments, per_point, points, planes);
}

}  // namespace warren
#endif
