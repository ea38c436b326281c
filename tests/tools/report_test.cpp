#include "tools/report/run_report.hpp"

#include <CppUTest/TestHarness.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "algo/core/scalar_math.hpp"
#include "hal/error.hpp"
#include "hal/results/line_file.hpp"
#include "tests/support/demo_run.hpp"
#include "tests/support/temp_folder.hpp"
#include "tools/report/mesh_picture.hpp"
#include "tools/report/svg_chart.hpp"

using namespace st;

TEST_GROUP(Report) {
  TempFolder temp;

  std::string report_of(const DemoRun& run) {
    write_demo_run(run, temp.path());
    return make_report(read_run(temp.path()));
  }
  static bool has(const std::string& page, const char* what) { return page.find(what) != std::string::npos; }
  static nlohmann::json data_of(const std::string& page) {
    const std::string open = "id=\"data\">";
    const std::size_t at = page.find(open) + open.size();
    return nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
  }
};

TEST(Report, HoldsEverythingAndRefersToNothingOutside) {
  const std::string page = report_of(circle_run(0.5, 0.02));
  for (const char* part :
       {"Preset and actual path", "as placed", "by shape", "radius", "Errors over time", "Speed and heading",
        "Tracking", "Reconstructed models", "Time of the loop", "Events", "data:image/png;base64,"})
    CHECK_TEXT(has(page, part), part);
  for (const char* outside :
       {"http://", "https://", "<link", "@import", "url(", "src=\"/", "nan", "undefined"})
    CHECK_FALSE_TEXT(has(page, outside), outside);
}

// The page and summary.json come to the same figures, though by two ways: from memory at the end, and read
// back.
TEST(Report, ItsFiguresAreThoseOfTheSummary) {
  const nlohmann::json data = data_of(report_of(square_run(0.8, 0.97)));
  const nlohmann::json summary = nlohmann::json::parse(read_whole_file(temp / "summary.json"));
  for (const char* key : {"rmse_as_placed_m", "rmse_shape_m", "max_m", "heading_rmse_rad", "in_band"})
    DOUBLES_EQUAL(summary["path"][key].get<double>(), data["path"][key].get<double>(), 2e-5);
  CHECK_FALSE(data["interrupted"].get<bool>());
}

TEST(Report, AnInterruptedRunIsShownAndSaysSo) {
  DemoRun run = square_run(0.5, 1);
  run.path.clear();
  write_demo_run(run, temp.path());
  for (const char* name : {"summary.json", "object-1.ply", "base-1.csv"})
    std::filesystem::remove(temp / name);
  const std::string csv = read_whole_file(temp / "object-1.csv");
  write_whole_file(temp / "object-1.csv", csv.substr(0, csv.size() - 40));  // cut in a line
  const std::string page = make_report(read_run(temp.path()));
  CHECK(has(page, "This run was interrupted."));
  CHECK(has(page, "Path on the floor"));
  CHECK_FALSE(has(page, "as placed"));
  CHECK(data_of(page)["interrupted"].get<bool>());
}

TEST(Report, ARunWithoutAnyObjectIsStillAPage) {
  DemoRun run = square_run(0.5, 1);
  run.with_object = false;
  const std::string page = report_of(run);
  CHECK(has(page, "Nothing was seen to move"));
  CHECK(has(page, "no_object"));
}

TEST(Report, TheProgramWritesItAndRefusesWhatIsNoRun) {
  write_demo_run(square_run(0.3, 1), temp.path());
  const auto run = [](const std::string& arguments) {
    return WEXITSTATUS(
        std::system((std::string(STARTRACK_BINARY) + " " + arguments + " >/dev/null 2>&1").c_str()));
  };
  LONGS_EQUAL(0, run("report " + temp.path()));
  CHECK(std::filesystem::file_size(temp / "report.html") > 20000);
  TempFolder empty;
  LONGS_EQUAL(2, run("report " + empty.path()));
  LONGS_EQUAL(2, run("report /nowhere/at/all"));
  LONGS_EQUAL(0, run("report --help"));
  LONGS_EQUAL(0, run("evaluate " + temp.path() + " --truth " + temp / "object-1.tum" + " --json"));
  LONGS_EQUAL(2, run("evaluate " + temp.path() + " --truth " + empty / "none.tum"));
}

TEST(Report, DamagedFilesAreNamed) {
  write_demo_run(square_run(0.3, 1), temp.path());
  write_whole_file(temp / "object-1.ply", "ply\nrubbish");
  try {
    read_run(temp.path());
    FAIL("took it");
  } catch (const Failure& failure) {
    STRCMP_CONTAINS("object-1.ply", failure.what());
  }
}

TEST_GROUP(Pictures){};

// Forward is up in the view from above: the bumper of the disc, dark, is at the top, whatever the base's
// place.
TEST(Pictures, TheViewFromAboveHasForwardUp) {
  const Pose2 base{0.01, 0.02, 2.2};
  const Mesh mesh = disc_mesh(base);
  const RgbaImage image = render_mesh(mesh.view(), frame_of(mesh.view()), view_from_above(base.yaw), 200);
  const auto red_at = [&](int u, int v) { return image.pixels[static_cast<std::size_t>(4 * (v * 200 + u))]; };
  CHECK(red_at(100, 14) < 90);
  CHECK(red_at(100, 186) > 150);
  LONGS_EQUAL(0, image.pixels[3]);  // corners are clear
}

TEST(Pictures, PngAndBase64AreWhatTheySay) {
  STRCMP_EQUAL("TWFu", base64("Man").c_str());
  STRCMP_EQUAL("TWE=", base64("Ma").c_str());
  STRCMP_EQUAL("TQ==", base64("M").c_str());
  const std::string png = encode_png({1, 1, {1, 2, 3, 255}});
  STRNCMP_EQUAL("\x89PNG\r\n", png.c_str(), 6);
}

TEST(Pictures, AChartTakesOddData) {
  Chart empty, flat;
  flat.series.push_back({"a<b", "actual", {{{1, 2}}, {}, {{1, 2}, {1, 2}}}});
  for (const Chart& chart : {empty, flat}) {
    const std::string svg = draw(chart);
    CHECK(svg.ends_with("</svg>"));
    CHECK(svg.find("nan") == std::string::npos && svg.find("inf") == std::string::npos);
  }
  CHECK(draw(flat).find("a&lt;b") != std::string::npos);
}
