// Where a run's files go, and which files those are.
#pragma once

#include <ctime>
#include <string>
#include <string_view>

namespace st {

// The name of a file that a run leaves behind (design, section 3), or the temporary name of one.
bool is_result_file(std::string_view name);

// N of "object-N.tum" and the like (prefix "object-", suffix ".tum"); 0 when the name is not of that form. N
// counts from 1 and has no leading zero.
int number_in_name(std::string_view name, std::string_view prefix, std::string_view suffix);

// `runs/YYYYmmdd-HHMMSS-SOURCE` for a local time; what a file name should not hold is replaced by '-'.
std::string default_run_name(const std::tm& local_time, std::string_view source);

// Makes the folder (and those above it) and returns its path. An empty `out` takes the default name, with
// "-2", "-3", ... appended when it is taken. A folder that is not empty is refused, unless `force`: then
// result files in it are deleted and nothing else is touched. A recording is refused even then, because
// path.csv is a file of both. Throws Failure (kBadInput) also when nothing can be written there.
std::string prepare_run_folder(const std::string& out, std::string_view source, bool force);

}  // namespace st
