// Path programs: small TOML files and CSV way points. What makes no sense is refused with file, line, what is
// wrong and what is allowed: Failure (kBadInput).
//
//   speed_mps = 0.2           # optional; also accel_mps2, turn_deg_per_s
//   area = { x_m = [-0.5, 2.0], y_m = [-1.0, 1.0] }   # optional: the floor that the robot may not leave
//   [[step]]
//   line = 1.0                # metres; negative: backwards
//   [[step]]
//   turn = 90                 # degrees in place, left is positive
//   [[step]]
//   arc = { radius_m = 0.4, angle_deg = 90 }
//   [[step]]
//   circle = { radius_m = 0.5, turns = 1, direction = "right" }   # turns 1 and "left" when left out
//   [[step]]
//   square = { side_m = 1.0 }                                     # direction as of a circle
//   [[step]]
//   polygon = { sides = 3, side_m = 0.8 }                         # direction as of a circle
//   [[step]]
//   figure_eight = { radius_m = 0.4, turns = 2 }                  # turns 1 when left out
//   [[step]]
//   wait = 2.0                # seconds
//   [[step]]
//   repeat = { times = 3, steps = [ { line = 0.5 }, { turn = 120 } ] }
//
// CSV: header `x,y`, then points in metres in the frame of the start (x forward, y left), driven by turns and
// lines.
#pragma once

#include <string>
#include <string_view>

#include "algo/control/path.hpp"

namespace st {

// `.csv` is read as way points, everything else as TOML.
Path load_path(const std::string& file);

// The same from memory; `name` stands for the file in messages.
Path parse_path_toml(std::string_view text, const std::string& name);
Path parse_path_csv(std::string_view text, const std::string& name);

}  // namespace st
