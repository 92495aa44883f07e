#include <algorithm>
#include <bit>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>

#include <png.h>

#include "image/codec.h"
#include "util/error.h"

namespace oitlab {
namespace {

/// libpng reports an error by longjmp, which must not skip destructors. Therefore each function
/// below that calls setjmp has only trivial local variables and returns whether it succeeded. Its
/// caller owns the memory.
struct Failure {
  char message[200] = "";
};

[[noreturn]] void onError(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::snprintf(failure->message, sizeof failure->message, "%s", message);
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}

struct Reader {
  explicit Reader(std::string_view file) : rest(file) {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    info = png ? png_create_info_struct(png) : nullptr;
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }

  Failure failure;
  std::string_view rest;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct Writer {
  Writer() {
    png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure, onError, onWarning);
    info = png ? png_create_info_struct(png) : nullptr;
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }

  Failure failure;
  std::string bytes;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

void takeBytes(png_structp png, png_bytep out, std::size_t count) {
  auto* reader = static_cast<Reader*>(png_get_io_ptr(png));
  if (reader->rest.size() < count) png_error(png, "the file ends too early");
  std::memcpy(out, reader->rest.data(), count);
  reader->rest.remove_prefix(count);
}

void addBytes(png_structp png, png_bytep bytes, std::size_t count) {
  auto* writer = static_cast<Writer*>(png_get_io_ptr(png));
  writer->bytes.append(reinterpret_cast<const char*>(bytes), count);
}

bool readHeader(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader, takeBytes);
  // Our own limit is checked instead, with a better message.
  png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  png_read_info(reader.png, reader.info);
  return true;
}

/// Converts every kind of PNG to RGBA with 8 or 16 bits in the byte order of this machine.
bool setUpConversion(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_expand(reader.png);
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xFFFF, PNG_FILLER_AFTER);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool readRows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

bool writeRows(Writer& writer, int width, int height, png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer, addBytes, nullptr);
  png_set_IHDR(writer.png, writer.info, width, height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(writer.png, writer.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_rows(writer.png, writer.info, rows);
  png_write_png(writer.png, writer.info, PNG_TRANSFORM_IDENTITY, nullptr);
  return true;
}

template <typename Sample>
void convertSamples(const std::vector<png_byte>& pixels, std::vector<float>& rgba) {
  for (std::size_t i = 0; i < rgba.size(); ++i) {
    Sample sample;
    std::memcpy(&sample, pixels.data() + i * sizeof sample, sizeof sample);
    rgba[i] = float(sample) / float(Sample(-1));
  }
}

png_byte quantize(float value, bool srgb) {
  // The comparison is also false for NaN, whose cast to an integer would be undefined.
  if (!(value > 0)) return 0;
  const float encoded = srgb ? value : srgbEncode(value);
  return png_byte(std::lround(std::min(encoded, 1.0F) * 255.0F));
}

std::vector<png_bytep> rowPointers(std::vector<png_byte>& pixels, int height) {
  std::vector<png_bytep> rows(height);
  for (int y = 0; y < height; ++y) rows[y] = pixels.data() + pixels.size() / height * y;
  return rows;
}

}  // namespace

Image decodePng(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0)
    fail<InputError>("{}: not a PNG file (it does not begin with the PNG signature)", name);
  Reader reader(bytes);
  if (!reader.info) throw std::bad_alloc();
  const auto failNow = [&] { fail<InputError>("{}: bad PNG: {}", name, reader.failure.message); };

  if (!readHeader(reader)) failNow();
  Image image;
  const png_uint_32 width = png_get_image_width(reader.png, reader.info);
  const png_uint_32 height = png_get_image_height(reader.png, reader.info);
  checkImageSize(width, height, name);
  image.width = int(width);
  image.height = int(height);
  image.srgb = true;

  if (!setUpConversion(reader)) failNow();
  std::vector<png_byte> pixels(png_get_rowbytes(reader.png, reader.info) * height);
  if (!readRows(reader, rowPointers(pixels, image.height).data())) failNow();

  image.rgba.resize(std::size_t(width) * height * 4);
  if (png_get_bit_depth(reader.png, reader.info) == 16)
    convertSamples<std::uint16_t>(pixels, image.rgba);
  else
    convertSamples<std::uint8_t>(pixels, image.rgba);
  return image;
}

std::string encodePng(const Image& image, const std::string& name) {
  std::vector<png_byte> pixels;
  pixels.reserve(std::size_t(image.width) * image.height * 3);
  for (std::size_t i = 0; i < image.rgba.size(); i += 4)
    for (int c = 0; c < 3; ++c) pixels.push_back(quantize(image.rgba[i + c], image.srgb));

  Writer writer;
  if (!writer.info) throw std::bad_alloc();
  std::vector<png_bytep> rows = rowPointers(pixels, image.height);
  if (!writeRows(writer, image.width, image.height, rows.data()))
    fail<InputError>("{}: cannot be encoded as PNG: {}", name, writer.failure.message);
  return std::move(writer.bytes);
}

}  // namespace oitlab
