#include "hal/results/run_record.hpp"

#include <algorithm>
#include <filesystem>

#include "hal/error.hpp"
#include "hal/results/csv_table.hpp"
#include "hal/results/line_file.hpp"
#include "hal/results/run_folder.hpp"

namespace st {
namespace fs = std::filesystem;
namespace {

std::vector<RunRecord::Column> read_columns(const std::string& path) {
  const std::string text = read_whole_file(path);
  const CsvTable table = parse_csv(text, path);
  std::vector<RunRecord::Column> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    columns.push_back({std::string(table.columns[c]), {}});
    columns.back().values.reserve(table.rows());
    for (std::size_t r = 0; r < table.rows(); ++r) columns.back().values.push_back(table.number(r, c));
  }
  return columns;
}

std::vector<RunRecord::EventRow> read_events(const std::string& path) {
  const std::string text = read_whole_file(path);
  const CsvTable table = parse_csv(text, path);
  const std::size_t t = table.column("t"), event = table.column("event"), object = table.column("object");
  const std::size_t a = table.column("a"), b = table.column("b"), c = table.column("c");
  std::vector<RunRecord::EventRow> events;
  for (std::size_t r = 0; r < table.rows(); ++r)
    events.push_back({table.number(r, t), std::string(table.text(r, event)),
                      static_cast<int>(table.number(r, object)), table.number(r, a), table.number(r, b),
                      table.number(r, c)});
  return events;
}

std::vector<std::array<double, 6>> read_path(const std::string& path) {
  const std::string text = read_whole_file(path);
  const CsvTable table = parse_csv(text, path);
  std::vector<std::array<double, 6>> rows(table.rows());
  std::size_t i = 0;
  for (const char* name : {"t", "x", "y", "yaw", "v", "w"}) {
    const std::size_t column = table.column(name);
    for (std::size_t r = 0; r < rows.size(); ++r) rows[r][i] = table.number(r, column);
    ++i;
  }
  return rows;
}

void read_objects(const std::string& folder, std::vector<RunRecord::Object>& objects) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const int id = number_in_name(entry.path().filename().string(), "object-", ".csv");
    if (id == 0) continue;
    const std::string csv = entry.path().string(), ply = folder + "/object-" + std::to_string(id) + ".ply";
    objects.push_back({id, parse_object_csv(read_whole_file(csv), csv), {}});
    if (fs::exists(ply)) objects.back().mesh = parse_ply(read_whole_file(ply), ply);
  }
  std::ranges::sort(objects, {}, &RunRecord::Object::id);
}

}  // namespace

const RunRecord::Column* RunRecord::timing_column(std::string_view name) const {
  const auto found = std::ranges::find(timing, name, &Column::name);
  return found == timing.end() ? nullptr : &*found;
}

RunRecord read_run(const std::string& folder) {
  const auto path_of = [&folder](const char* name) { return folder + "/" + name; };
  if (!fs::is_directory(folder))
    throw Failure(ExitCode::kBadInput, folder + ": is not a folder; give the folder of a run");
  if (!fs::exists(path_of("timing.csv")) || !fs::exists(path_of("events.csv")))
    throw Failure(ExitCode::kBadInput,
                  folder +
                      ": is not a run (it has no timing.csv and events.csv); give the folder that "
                      "`startrack run` or `startrack replay` named in its last line");
  RunRecord record;
  record.folder = folder;
  if (const std::string name = path_of("summary.json"); fs::exists(name))
    record.summary = parse_summary(read_whole_file(name), name);
  record.timing = read_columns(path_of("timing.csv"));
  record.events = read_events(path_of("events.csv"));
  read_objects(folder, record.objects);
  if (fs::exists(path_of("path.csv"))) record.path = read_path(path_of("path.csv"));
  if (fs::exists(path_of("camera.tum")))
    record.camera = parse_tum(read_whole_file(path_of("camera.tum"))).poses;
  if (fs::exists(path_of("scene.ply")))
    record.scene = parse_ply(read_whole_file(path_of("scene.ply")), path_of("scene.ply"));
  return record;
}

}  // namespace st
