// The single measures of an evaluation.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <utility>
#include <vector>

#include "algo/core/pose.hpp"

namespace st {

using EvaluationJson = nlohmann::ordered_json;

// One-to-one nearest pairs (truth, estimate) within 20 ms, closest first; in order of the truth.
std::vector<std::pair<std::size_t, std::size_t>> associate(std::span<const double> truth_t,
                                                           std::span<const double> estimate_t);

// {"rmse", "mean", "median", "p95", "max"} of values * scale; null without values.
EvaluationJson statistics(std::vector<double> values, double scale);

// Relative pose error over one second.
EvaluationJson relative_error(std::span<const double> t, std::span<const Pose> estimate,
                              std::span<const Pose> truth);

// Runs of live truth frames without an estimate, after the first one.
EvaluationJson gaps(std::span<const double> t, const std::vector<bool>& have, const std::vector<bool>& live);

// Length of the way, in the unit of the poses.
double way_length(std::span<const Pose> poses);

}  // namespace st
