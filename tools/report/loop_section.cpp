#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/report/sections.hpp"
#include "tools/report/svg_chart.hpp"

namespace st {
namespace {

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const std::size_t at = std::min(
      values.size() - 1,
      static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - (share > 0 ? 1 : 0));
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(at));
  return values[at];
}

std::string milliseconds(double us) { return number(us * 1e-3, 3); }

std::string histogram(const std::vector<double>& cpu_us) {
  constexpr std::size_t kBins = 60;
  const double most = *std::ranges::max_element(cpu_us);
  BarChart chart;
  chart.x_label = "CPU time of a frame (ms)";
  chart.y_label = "frames";
  chart.log_heights = true;
  const double width = std::max(most * 1.02, 1.0) / kBins;
  for (std::size_t i = 0; i <= kBins; ++i) chart.edges.push_back(width * static_cast<double>(i) * 1e-3);
  chart.heights.assign(kBins, 0);
  for (const double us : cpu_us)
    chart.heights[std::min(kBins - 1, static_cast<std::size_t>(std::max(0.0, us) / width))] += 1;
  return figure(
      draw(chart),
      "How long the frames took, integration included; logarithmic, so that a single slow frame shows.");
}

std::string stage_table(const RunRecord& run) {
  std::string out =
      "<table><thead><tr><th>ms</th><th>p50</th><th>p99</th><th>p99.9</th><th>largest</th></tr></"
      "thead><tbody>";
  for (const RunRecord::Column& column : run.timing) {
    if (!column.name.ends_with("_us") || column.values.empty()) continue;
    const std::string name = column.name.substr(0, column.name.size() - 3);
    const bool total = name == "cpu" || name == "frame";
    out += std::string(total ? "<tr class=\"total\">" : "<tr>") + "<th>" + escape_html(name) + "</th>";
    for (const double share : {0.5, 0.99, 0.999, 1.0})
      out += "<td>" + milliseconds(percentile(column.values, share)) + "</td>";
    out += "</tr>";
  }
  return out +
         "</tbody></table><p class=\"note\"><b>frame</b>: from handed over until published, by the clock; "
         "<b>cpu</b>: the same in "
         "CPU time of the loop; <b>age</b>: how old a frame was when it was handed over.</p>";
}

std::string worst_table(const ReportInput& input, const std::vector<double>& cpu_us) {
  const RunRecord::Column* t = input.run.timing_column("t");
  const RunRecord::Column* frame = input.run.timing_column("frame");
  if (t == nullptr || frame == nullptr) return {};
  std::vector<std::size_t> order(cpu_us.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  constexpr std::size_t kWorst = 5;
  const std::size_t count = std::min(kWorst, order.size());
  std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(count),
                            [&](std::size_t a, std::size_t b) { return cpu_us[a] > cpu_us[b]; });
  std::string out =
      "<table><thead><tr><th>slowest frames</th><th>time (s)</th><th>CPU (ms)</th><th>longest "
      "stage</th></tr></thead><tbody>";
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t r = order[i];
    const RunRecord::Column* longest = nullptr;
    for (const RunRecord::Column& c : input.run.timing) {
      const bool stage =
          c.name.ends_with("_us") && c.name != "cpu_us" && c.name != "frame_us" && c.name != "age_us";
      if (stage && (longest == nullptr || c.values[r] > longest->values[r])) longest = &c;
    }
    out += "<tr><th>" + number(frame->values[r], 0) + "</th><td>" + number(t->values[r] - input.t0_s, 2) +
           "</td><td>" + milliseconds(cpu_us[r]) + "</td><td>";
    if (longest != nullptr)
      out += escape_html(longest->name.substr(0, longest->name.size() - 3)) + " " +
             milliseconds(longest->values[r]);
    out += "</td></tr>";
  }
  return out + "</tbody></table>";
}

// What the three numbers of an event mean, in words.
std::string details(const RunRecord::EventRow& e) {
  if (e.event == "damaged") return number(e.a, 0) + " frames skipped so far";
  if (e.event == "gap") return number(e.a, 3) + " s, " + number(e.b, 0) + " frames missing";
  if (e.event == "lost") return number(e.a, 2) + " s after its last good pose";
  if (e.event == "recovered") return "after " + number(e.a, 2) + " s without a pose";
  if (e.event == "interrupted") return "signal " + number(e.a, 0);
  if (e.event == "robot_fault") return "fault " + number(e.a, 0);
  return {};
}

}  // namespace

std::string loop_section(const ReportInput& input) {
  const RunRecord::Column* cpu = input.run.timing_column("cpu_us");
  if (cpu == nullptr || cpu->values.empty()) return {};
  return section("Time of the loop",
                 histogram(cpu->values) + stage_table(input.run) + worst_table(input, cpu->values));
}

std::string event_section(const ReportInput& input) {
  constexpr std::size_t kShown = 60;
  std::string rows;
  for (std::size_t i = 0; i < std::min(kShown, input.run.events.size()); ++i) {
    const RunRecord::EventRow& e = input.run.events[i];
    rows += "<tr><td>" + number(e.t_s - input.t0_s, 2) + "</td><th>" + escape_html(e.event) + "</th><td>" +
            (e.object > 0 ? std::to_string(e.object) : "") + "</td><td class=\"words\">" + details(e) +
            "</td></tr>";
  }
  if (rows.empty()) return section("Events", "<p>Nothing happened to the data.</p>");
  std::string more;
  if (input.run.events.size() > kShown)
    more = "<p class=\"note\">And " + std::to_string(input.run.events.size() - kShown) +
           " more in events.csv.</p>";
  return section("Events",
                 "<table class=\"events\"><thead><tr><th>time "
                 "(s)</th><th>event</th><th>object</th><th></th></tr></thead><tbody>" +
                     rows + "</tbody></table>" + more);
}

}  // namespace st
