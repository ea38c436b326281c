// Scores trajectories against ground truth, with the measures and the JSON of the project's evaluation script
// (eval_traj.py): the offset between the tracker's object frame and the truth's is solved for and taken out.
#pragma once

#include <string>
#include <vector>

#include "hal/results/tum_file.hpp"

namespace st {

// A file of poses under a name that the result repeats.
struct NamedTrajectory {
  std::string name;
  TumTrajectory trajectory;
};

// Which frames had the object in sight (visible.csv): columns host_t, clk_t, NAME_px, NAME_frac. Empty text:
// all of them.
struct Visibility {
  std::string text, name;
};

// One JSON object, lengths in mm, angles in degrees, times in s. Object mode: poses of objects in the
// camera's frame; with several truths an object {"objects": [...]}. Throws Failure (kBadInput) for a
// visibility file that does not fit.
std::string evaluate_objects(const std::vector<NamedTrajectory>& truths,
                             const std::vector<NamedTrajectory>& estimates, const Visibility& visibility);
// Camera mode: poses of the camera in a world; after SE(3) alignment, and after aligning the first pose.
std::string evaluate_camera(const NamedTrajectory& truth, const NamedTrajectory& estimate);

// The same for people: a table of what matters.
std::string evaluation_table(const std::string& json);

}  // namespace st
