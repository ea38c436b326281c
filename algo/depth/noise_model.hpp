// How far off a depth reading is: one standard deviation, for weights.
#pragma once

#include <span>

#include "algo/depth/depth_tables.hpp"

namespace st {

// Along the ray's depth, metres, at depth z_m. Triangulation noise is constant in disparity, so sigma = z^2 /
// K times the noise in codes: matching noise of half a Kinect step (Khoshelham & Elberink 2012: 1.425e-3 z^2
// m) and the uniform error of the stored step. `cos_incidence` is |normal . ray|: towards grazing angles
// matching windows mix depths (Nguyen, Izadi & Lovell 2012), which is bounded here at 80 degrees.
double sigma_z_m(const DepthTables& tables, double z_m, double cos_incidence = 1.0);

// Across the ray, metres: 0.8 pixels (Nguyen et al. 2012), head-on.
double sigma_lateral_m(const DepthTables& tables, double z_m);

// 1 / sigma_z^2 (1/m^2) by code, head-on; weights[0] = 0. At most kCodes entries are filled.
void fill_weights(const DepthTables& tables, std::span<float> weights);

}  // namespace st
