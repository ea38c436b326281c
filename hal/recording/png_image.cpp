#include "hal/recording/png_image.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include "algo/core/calibration.hpp"

namespace st {
namespace {

enum class Want { kDepth16, kColor8 };

// What the callbacks of libpng share with decode(); plain data, since errors leave libpng by longjmp.
struct Job {
  const std::uint8_t* data = nullptr;
  std::size_t size = 0, at = 0;
  bool ran_out = false;
  char error[96] = {};
  int width = 0, height = 0, bit_depth = 0, color_type = 0;
  bool wrong_kind = false, too_large = false;
  png_bytep rows[kMaxHeight] = {};
};

void on_read(png_structp png, png_bytep to, std::size_t bytes) {
  auto* job = static_cast<Job*>(png_get_io_ptr(png));
  if (job->size - job->at < bytes) {
    job->ran_out = true;
    png_error(png, "ends early");
  }
  std::memcpy(to, job->data + job->at, bytes);
  job->at += bytes;
}

void on_error(png_structp png, png_const_charp message) {
  auto* job = static_cast<Job*>(png_get_error_ptr(png));
  std::snprintf(job->error, sizeof job->error, "%s", message);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void convert_to_rgb8(png_structp png, const Job& job) {
  png_set_expand(png);
  if (job.bit_depth == 16) png_set_strip_16(png);
  if ((job.color_type & PNG_COLOR_MASK_COLOR) == 0) png_set_gray_to_rgb(png);
  png_set_strip_alpha(png);
}

// Nothing with a destructor may live in here: libpng's errors jump over it.
bool decode_rows(Job& job, Want want, std::uint8_t* out, std::size_t out_bytes) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job, on_error, on_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr || setjmp(png_jmpbuf(png)) != 0) {  // NOLINT(cert-err52-cpp): libpng knows no other way
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &job, on_read);
  // Text and profiles of foreign files are of no interest, and no reason to allocate.
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_set_chunk_malloc_max(png, 1 << 20);
  png_read_info(png, info);
  job.width = static_cast<int>(std::min<png_uint_32>(png_get_image_width(png, info), 1u << 30));
  job.height = static_cast<int>(std::min<png_uint_32>(png_get_image_height(png, info), 1u << 30));
  job.bit_depth = png_get_bit_depth(png, info);
  job.color_type = png_get_color_type(png, info);
  job.wrong_kind = want == Want::kDepth16 && (job.bit_depth != 16 || job.color_type != PNG_COLOR_TYPE_GRAY);
  const std::size_t row_bytes = static_cast<std::size_t>(job.width) * (want == Want::kDepth16 ? 2 : 3);
  job.too_large = job.width > kMaxWidth || job.height > kMaxHeight ||
                  row_bytes * static_cast<std::size_t>(job.height) > out_bytes;
  if (job.wrong_kind || job.too_large) png_error(png, "not wanted");
  if (want == Want::kDepth16)
    png_set_swap(png);  // PNG is big-endian, the baseline is x86-64
  else
    convert_to_rgb8(png, job);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != row_bytes) png_error(png, "unexpected pixel format");
  for (int v = 0; v < job.height; ++v) job.rows[v] = out + static_cast<std::size_t>(v) * row_bytes;
  png_read_image(png, job.rows);
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

ImageVerdict decode(std::span<const std::uint8_t> file, Want want, std::uint8_t* out, std::size_t out_bytes) {
  Job job;
  job.data = file.data();
  job.size = file.size();
  ImageVerdict verdict;
  verdict.ok = decode_rows(job, want, out, out_bytes);
  verdict.width = job.width;
  verdict.height = job.height;
  if (verdict.ok) return verdict;
  if (job.wrong_kind) {
    const bool gray = job.color_type == PNG_COLOR_TYPE_GRAY;
    verdict.what = "a " + std::to_string(job.bit_depth) + "-bit " + (gray ? "grey" : "colour") +
                   " PNG; depth is expected as 16-bit grey PNG";
  } else if (job.too_large) {
    verdict.reason = DamageReason::kWrongSize;
    verdict.what =
        std::to_string(job.width) + "x" + std::to_string(job.height) + " pixels; 640x480 is the largest";
  } else {
    verdict.reason = job.ran_out ? DamageReason::kShort : DamageReason::kForeign;
    verdict.what = job.ran_out ? "ends early" : std::string("no readable PNG (") + job.error + ")";
  }
  return verdict;
}

}  // namespace

ImageVerdict decode_png_depth(std::span<const std::uint8_t> file, std::span<std::uint16_t> out) {
  return decode(file, Want::kDepth16, reinterpret_cast<std::uint8_t*>(out.data()), out.size_bytes());
}

ImageVerdict decode_png_color(std::span<const std::uint8_t> file, std::span<std::uint8_t> out) {
  return decode(file, Want::kColor8, out.data(), out.size_bytes());
}

}  // namespace st
