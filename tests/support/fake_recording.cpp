#include "tests/support/fake_recording.hpp"

#include <png.h>

#include <algorithm>

#include "hal/error.hpp"
#include "hal/recording/fakenect_index.hpp"
#include "tests/support/recorded_data.hpp"

namespace st::test {
namespace {

std::string png(std::uint32_t format, const std::vector<std::uint8_t>& pixels, int width, int height) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<std::uint32_t>(width);
  image.height = static_cast<std::uint32_t>(height);
  image.format = format;
  png_alloc_size_t bytes = 0;
  png_image_write_to_memory(&image, nullptr, &bytes, 0, pixels.data(), 0, nullptr);
  std::string file(bytes, '\0');
  png_image_write_to_memory(&image, file.data(), &bytes, 0, pixels.data(), 0, nullptr);
  return file;
}

// libpng's simple writer takes 16-bit samples for linear light and stores gamma with them, but not other
// values.
void on_write(png_structp out, png_bytep data, std::size_t bytes) {
  static_cast<std::string*>(png_get_io_ptr(out))->append(reinterpret_cast<char*>(data), bytes);
}

std::size_t area(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

std::string pgm(int value, int width, int height) {
  std::string file = "P5 " + std::to_string(width) + " " + std::to_string(height) + " 65535\n";
  for (std::size_t i = 0; i < area(width, height); ++i) {
    file += static_cast<char>(value & 255);
    file += static_cast<char>(value >> 8);
  }
  return file;
}

std::string ppm(int value, int width, int height) {
  return "P6 " + std::to_string(width) + " " + std::to_string(height) + " 255\n" +
         std::string(3 * area(width, height), static_cast<char>(value));
}

std::string png_gray16(int value, int width, int height) {
  std::string file;
  png_structp out = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(out);
  png_set_write_fn(out, &file, on_write, nullptr);
  png_set_IHDR(out, info, static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 16,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(out, info);
  std::vector<std::uint8_t> row(2 * static_cast<std::size_t>(width));
  for (std::size_t u = 0; u < row.size(); ++u)
    row[u] = static_cast<std::uint8_t>(u % 2 == 0 ? value >> 8 : value & 255);
  for (int v = 0; v < height; ++v) png_write_row(out, row.data());
  png_write_end(out, nullptr);
  png_destroy_write_struct(&out, &info);
  return file;
}

std::string png_gray8(int value, int width, int height) {
  return png(PNG_FORMAT_GRAY,
             std::vector<std::uint8_t>(area(width, height), static_cast<std::uint8_t>(value)), width, height);
}

std::string png_rgb8(int value, int width, int height) {
  return png(PNG_FORMAT_RGB,
             std::vector<std::uint8_t>(3 * area(width, height), static_cast<std::uint8_t>(value)), width,
             height);
}

double host_of(int k) { return 1000.0 + k / 30.0; }
std::uint32_t ticks_of(int k, std::uint32_t first_ticks) {
  return first_ticks + static_cast<std::uint32_t>(k) * 2'000'000u;
}

void write_camera_toml(const std::string& folder, bool color) {
  const std::string size = "width = 8\nheight = 4\n";
  write_file(folder + "/camera.toml", size + (color ? "[color]\n" + size : ""));
}

void add_named(const std::string& folder, const std::string& name, const std::string& content) {
  write_file(folder + "/" + name, content);
  append_file(folder + "/INDEX.txt", name + "\n");
}

void add_depth(const std::string& folder, int k, int value, std::uint32_t first_ticks) {
  add_named(folder, fakenect_name('d', host_of(k), ticks_of(k, first_ticks)), pgm(value));
}

void add_color(const std::string& folder, int k, int value, std::uint32_t first_ticks) {
  add_named(folder, fakenect_name('r', host_of(k), ticks_of(k, first_ticks)), ppm(value));
}

std::vector<Event> Seen::events(EventKind kind) const {
  std::vector<Event> found;
  for (const SeenFrame& frame : frames)
    std::copy_if(frame.input.events.begin(), frame.input.events.end(), std::back_inserter(found),
                 [kind](const Event& event) { return event.kind == kind; });
  return found;
}

Seen read_all(FrameSource& source) {
  Seen seen;
  seen.info = source.info();
  source.start();
  FrameInput input;
  while ((seen.end = source.next(input, 10'000)) == FrameSource::Result::kFrame) {
    SeenFrame frame;
    frame.depth.assign(input.depth.data, input.depth.data + input.depth.pixels());
    if (!input.color.empty()) frame.color.assign(input.color.data, input.color.data + input.color.pixels());
    frame.input = input;
    frame.input.depth = {};
    frame.input.color = {};
    seen.frames.push_back(std::move(frame));
  }
  source.stop();
  return seen;
}

Seen read_all(const std::string& folder, const std::string& camera_file) {
  SourceOptions options;
  options.spec = folder;
  options.camera_file = camera_file;
  return read_all(*open_source(options));
}

std::string why_not(const std::string& spec, const std::string& camera_file) {
  SourceOptions options;
  options.spec = spec;
  options.camera_file = camera_file;
  try {
    open_source(options);
    return {};
  } catch (const Failure& failure) {
    return failure.what();
  }
}

}  // namespace st::test
