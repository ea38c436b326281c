#include "algo/depth/noise_model.hpp"

#include <cmath>

namespace st {
namespace {

constexpr double kMatchingCodes = 3.94;  // 1.425e-3 m^-1 times K = 8 * 345.4894: half a raw step
constexpr double kRawStepCodes = 8.0;
constexpr double kGrazing = 0.1736;  // cos 80 degrees

}  // namespace

double sigma_z_m(const DepthTables& tables, double z_m, double cos_incidence) {
  const double k = tables.codes_per_inverse_m();
  const double q = k / z_m;
  const double step =
      tables.step_per_squared_code() > 0 ? q * q * tables.step_per_squared_code() : kRawStepCodes;
  const double codes = std::sqrt(kMatchingCodes * kMatchingCodes + step * step / 12.0);
  const double head_on = codes * z_m * z_m / k;
  // Nguyen's grazing term, 0.0001/sqrt(z) (theta/(pi/2 - theta))^2, with tan(theta) in place of the quotient:
  // the two agree within a quarter up to 70 degrees, and the tangent needs no angle.
  const double c = cos_incidence > kGrazing ? cos_incidence : kGrazing;
  const double tangent_squared = c < 1.0 ? 1.0 / (c * c) - 1.0 : 0.0;
  return head_on + 0.0001 / std::sqrt(z_m) * tangent_squared;
}

double sigma_lateral_m(const DepthTables& tables, double z_m) {
  return 0.8 * z_m / tables.calibration().depth.fx;
}

void fill_weights(const DepthTables& tables, std::span<float> weights) {
  const std::size_t count = weights.size() < kCodes ? weights.size() : kCodes;
  for (std::size_t q = 0; q < count; ++q) {
    const double z = static_cast<double>(tables.z_of_code()[q]);
    const double sigma = z > 0 ? sigma_z_m(tables, z) : 0;
    weights[q] = sigma > 0 ? static_cast<float>(1.0 / (sigma * sigma)) : 0.0f;
  }
}

}  // namespace st
