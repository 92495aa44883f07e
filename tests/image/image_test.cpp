#include "image/image.h"

#include <fstream>
#include <limits>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include "image/hash.h"
#include "support/temporary_folder.h"
#include "util/error.h"
#include "util/text_file.h"

namespace oitlab {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using ImageFile = TemporaryFolder;

Image makeImage(int width, int height, std::vector<float> rgba, bool srgb = false) {
  return {width, height, srgb, std::move(rgba)};
}

Image makeRamp(int width, int height) {
  Image image = makeImage(width, height, std::vector<float>(std::size_t(width) * height * 4));
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = float(i % 256) / 255.0F;
  return image;
}

/// Writes a PNG of any kind, because readImage() must read the files of other programs.
void writePng(const std::filesystem::path& path, int colorType, int bitDepth, int width,
              std::vector<std::vector<png_byte>> rows, std::vector<png_color> palette = {},
              int interlace = PNG_INTERLACE_NONE) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_init_io(png, file);
  png_set_IHDR(png, info, width, png_uint_32(rows.size()), bitDepth, colorType, interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), int(palette.size()));
  std::vector<png_bytep> pointers;
  pointers.reserve(rows.size());
  for (auto& row : rows) pointers.push_back(row.data());
  png_set_rows(png, info, pointers.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

/// A 2 x 1 EXR whose channels all hold 0.25 and 0.5.
void writeExr(const std::filesystem::path& path, const std::vector<std::string>& channels,
              Imf::PixelType type = Imf::FLOAT) {
  float floats[] = {0.25F, 0.5F};
  half halves[] = {half(0.25F), half(0.5F)};
  unsigned integers[] = {0, 1};
  char* pixels = type == Imf::HALF    ? reinterpret_cast<char*>(halves)
                 : type == Imf::FLOAT ? reinterpret_cast<char*>(floats)
                                      : reinterpret_cast<char*>(integers);
  const std::size_t size = type == Imf::HALF ? 2 : 4;
  Imf::Header header(2, 1);
  Imf::FrameBuffer frame;
  for (const std::string& channel : channels) {
    header.channels().insert(channel, Imf::Channel(type));
    frame.insert(channel, Imf::Slice(type, pixels, size, 2 * size));
  }
  Imf::OutputFile file(path.c_str(), header);
  file.setFrameBuffer(frame);
  file.writePixels(1);
}

void writeText(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::string readFailure(const std::filesystem::path& path) {
  return messageOf<InputError>([&] { readImage(path); });
}

TEST(Srgb, MatchesTheStandardAtKnownPoints) {
  EXPECT_EQ(srgbEncode(0), 0);
  EXPECT_NEAR(srgbEncode(1), 1, 1e-6);
  EXPECT_NEAR(srgbEncode(0.001F), 0.01292, 1e-7);   // the linear part
  EXPECT_NEAR(srgbEncode(0.21404114F), 0.5, 1e-6);  // mid grey
  EXPECT_NEAR(srgbDecode(0.5F), 0.21404114, 1e-6);
  for (int i = 0; i <= 255; ++i) EXPECT_NEAR(srgbEncode(srgbDecode(i / 255.0F)), i / 255.0F, 2e-6);
}

TEST(ImageHash, IsXxh3Of128Bits) {
  // The published value of the empty input.
  EXPECT_EQ(imageHash({}), "99aa06d3014798d86001c324468d497f");
  const std::byte zero{0};
  const std::byte one{1};
  EXPECT_NE(imageHash({&zero, 1}), imageHash({&one, 1}));
}

TEST_F(ImageFile, PngKeepsEncodedBytes) {
  Image image = makeRamp(8, 8);
  image.srgb = true;
  writeImage(folder_ / "a.png", image);
  const Image read = readImage(folder_ / "a.png");
  ASSERT_EQ(read.width, 8);
  ASSERT_EQ(read.height, 8);
  EXPECT_TRUE(read.srgb);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    EXPECT_EQ(read.rgba[i], i % 4 == 3 ? 1.0F : image.rgba[i]) << i;  // alpha is dropped
}

TEST_F(ImageFile, PngEncodesLinearAndRoundsAndClamps) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  writeImage(folder_ / "a.png", makeImage(2, 1, {0.21404114F, -1, 7, 1, nan, infinity, 0, 1}));
  // Mid grey is 127.5 of 255, 7 is clamped, and a NaN must not become an arbitrary byte.
  const Image read = readImage(folder_ / "a.png");
  EXPECT_NEAR(read.rgba[0], 127.5 / 255, 0.51 / 255);
  EXPECT_EQ(read.rgba[1], 0);
  EXPECT_EQ(read.rgba[2], 1);
  EXPECT_EQ(read.rgba[4], 0);
  EXPECT_EQ(read.rgba[5], 1);
}

TEST_F(ImageFile, PngOfEveryKindIsRead) {
  writePng(folder_ / "grey.png", PNG_COLOR_TYPE_GRAY, 8, 2, {{0, 51}});
  EXPECT_THAT(readImage(folder_ / "grey.png").rgba, ElementsAre(0, 0, 0, 1, 0.2F, 0.2F, 0.2F, 1));

  writePng(folder_ / "bits.png", PNG_COLOR_TYPE_GRAY, 1, 2, {{0x40}});
  EXPECT_THAT(readImage(folder_ / "bits.png").rgba, ElementsAre(0, 0, 0, 1, 1, 1, 1, 1));

  writePng(folder_ / "rgba.png", PNG_COLOR_TYPE_RGB_ALPHA, 8, 1, {{255, 0, 51, 102}});
  EXPECT_THAT(readImage(folder_ / "rgba.png").rgba, ElementsAre(1, 0, 0.2F, 0.4F));

  writePng(folder_ / "palette.png", PNG_COLOR_TYPE_PALETTE, 8, 2, {{1, 0}},
           {{255, 0, 0}, {0, 51, 255}});
  EXPECT_THAT(readImage(folder_ / "palette.png").rgba, ElementsAre(0, 0.2F, 1, 1, 1, 0, 0, 1));

  // All 16 bits are read (big-endian in the file): 0x0100 is 256 of 65535, not 1 of 255.
  writePng(folder_ / "deep.png", PNG_COLOR_TYPE_RGB, 16, 1, {{0x01, 0x00, 0xFF, 0xFF, 0, 1}});
  EXPECT_THAT(readImage(folder_ / "deep.png").rgba,
              ElementsAre(256.0F / 65535, 1, 1.0F / 65535, 1));

  writePng(folder_ / "interlaced.png", PNG_COLOR_TYPE_GRAY, 8, 2, {{0, 51}, {102, 255}}, {},
           PNG_INTERLACE_ADAM7);
  const Image interlaced = readImage(folder_ / "interlaced.png");
  EXPECT_EQ(interlaced.at(1, 0)[0], 0.2F);
  EXPECT_EQ(interlaced.at(0, 1)[0], 0.4F);
}

TEST_F(ImageFile, ExrKeepsFloatsBitForBit) {
  Image image = makeRamp(5, 3);
  image.rgba[0] = 1e-30F;
  image.rgba[1] = -70000;  // beyond the range of a half float
  image.rgba[2] = std::numeric_limits<float>::infinity();
  writeImage(folder_ / "a.exr", image);
  const Image read = readImage(folder_ / "a.exr");
  EXPECT_EQ(read.width, 5);
  EXPECT_EQ(read.height, 3);
  EXPECT_FALSE(read.srgb);
  EXPECT_EQ(read.rgba, image.rgba);
}

TEST_F(ImageFile, ExrIsLinear) {
  writeImage(folder_ / "a.exr", makeImage(1, 1, {0.5F, 0, 1, 0.5F}, /*srgb=*/true));
  const Image read = readImage(folder_ / "a.exr");
  EXPECT_NEAR(read.rgba[0], 0.21404114, 1e-6);
  EXPECT_EQ(read.rgba[3], 0.5F);
}

TEST_F(ImageFile, ExrOfEveryKindIsRead) {
  writeExr(folder_ / "rgb.exr", {"R", "G", "B"}, Imf::HALF);
  EXPECT_THAT(readImage(folder_ / "rgb.exr").rgba,
              ElementsAre(0.25F, 0.25F, 0.25F, 1, 0.5F, 0.5F, 0.5F, 1));
  writeExr(folder_ / "grey.exr", {"Y", "A"});
  EXPECT_THAT(readImage(folder_ / "grey.exr").rgba,
              ElementsAre(0.25F, 0.25F, 0.25F, 0.25F, 0.5F, 0.5F, 0.5F, 0.5F));
}

TEST_F(ImageFile, ExrWithoutColorIsRefused) {
  writeExr(folder_ / "depth.exr", {"Z", "A"});
  const std::string message = readFailure(folder_ / "depth.exr");
  EXPECT_THAT(message, HasSubstr("depth.exr"));
  EXPECT_THAT(message, HasSubstr("channels A, Z, wanted R, G, B or Y"));
  writeExr(folder_ / "chroma.exr", {"Y", "RY", "BY"});
  EXPECT_THAT(readFailure(folder_ / "chroma.exr"), HasSubstr("channels BY, RY, Y"));
  writeExr(folder_ / "ids.exr", {"R", "G", "B"}, Imf::UINT);
  EXPECT_THAT(readFailure(folder_ / "ids.exr"), HasSubstr("channel R holds integers"));
}

TEST_F(ImageFile, MalformedFilesAreNamed) {
  writeImage(folder_ / "whole.png", makeRamp(64, 64));
  writeImage(folder_ / "whole.exr", makeRamp(64, 64));
  for (const std::string kind : {"png", "exr"}) {
    const std::string whole = readTextFile(folder_ / ("whole." + kind));
    const std::filesystem::path path = folder_ / ("broken." + kind);
    // Cut at every place: in the signature, the header, the pixels and the end.
    for (const std::size_t size : {std::size_t(0), std::size_t(3), std::size_t(20),
                                   whole.size() / 8, whole.size() / 2, whole.size() - 30}) {
      writeText(path, whole.substr(0, size));
      EXPECT_THAT(readFailure(path), HasSubstr(path.string())) << kind << " cut to " << size;
    }
    writeText(path, "This is text, and long enough for every header.\n");
    EXPECT_THAT(readFailure(path), HasSubstr("it does not begin with")) << kind;
  }
  std::string damaged = readTextFile(folder_ / "whole.png");
  damaged[damaged.size() / 2] ^= 0x55;
  writeText(folder_ / "damaged.png", damaged);
  EXPECT_THAT(readFailure(folder_ / "damaged.png"), HasSubstr("bad PNG"));
}

TEST_F(ImageFile, AbsurdSizesAreRefusedBeforeTheyAreAllocated) {
  writeImage(folder_ / "a.png", makeRamp(1, 1));
  std::string bytes = readTextFile(folder_ / "a.png");
  bytes[17] = 1;  // width 0x00010001; the checksum is corrected, or libpng would reject it
  const uLong checksum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + 12), 17);
  for (int i = 0; i < 4; ++i) bytes[29 + i] = char(checksum >> (24 - 8 * i));
  writeText(folder_ / "wide.png", bytes);
  EXPECT_THAT(readFailure(folder_ / "wide.png"),
              HasSubstr("image of 65537 x 1 pixels, wanted 1 to 32768 on a side"));

  writeImage(folder_ / "a.exr", makeRamp(1, 1));
  bytes = readTextFile(folder_ / "a.exr");
  const std::size_t window =
      bytes.find("dataWindow") + std::string_view("dataWindow0box2i0size").size();
  bytes[window + 10] = 1;  // xMax = 0x00010000
  writeText(folder_ / "wide.exr", bytes);
  EXPECT_THAT(readFailure(folder_ / "wide.exr"), HasSubstr("image of 65537 x 1 pixels"));

  bytes = readTextFile(folder_ / "a.exr");
  const std::size_t size = bytes.find("channels") + std::string_view("channels0chlist0").size();
  bytes[size + 3] = 0x7F;  // its highest byte
  writeText(folder_ / "long.exr", bytes);
  EXPECT_THAT(readFailure(folder_ / "long.exr"),
              HasSubstr("bad EXR: an attribute of 2130706505 bytes, and the file ends after"));

  EXPECT_THAT(messageOf<InputError>([&] { writeImage(folder_ / "none.png", Image{}); }),
              HasSubstr("none.png: image of 0 x 0 pixels"));
}

TEST_F(ImageFile, UnknownExtensionsAreNamed) {
  EXPECT_THAT(readFailure(folder_ / "a.jpg"),
              HasSubstr("a.jpg: unknown image extension '.jpg', wanted .png or .exr"));
  EXPECT_THAT(messageOf<InputError>([&] { writeImage(folder_ / "a", makeRamp(1, 1)); }),
              HasSubstr("unknown image extension ''"));
  writeImage(folder_ / "A.PNG", makeRamp(1, 1));
  EXPECT_EQ(readImage(folder_ / "A.PNG").width, 1);
}

TEST_F(ImageFile, UnreadableFilesAreNamed) {
  EXPECT_THAT(readFailure(folder_ / "absent.png"),
              HasSubstr("absent.png: cannot be opened: No such file"));
  std::filesystem::create_directory(folder_ / "folder.exr");
  EXPECT_THAT(readFailure(folder_ / "folder.exr"), HasSubstr("folder.exr: is not a regular file"));
}

TEST_F(ImageFile, FailedWritesLeaveNothing) {
  EXPECT_THAT(
      messageOf<InputError>([&] { writeImage(folder_ / "absent" / "a.png", makeRamp(1, 1)); }),
      HasSubstr("a.png: cannot be written: No such file"));
  // The target cannot be replaced after the temporary file was written, which must be removed.
  std::filesystem::create_directories(folder_ / "a.exr" / "inner");
  EXPECT_THAT(messageOf<InputError>([&] { writeImage(folder_ / "a.exr", makeRamp(1, 1)); }),
              HasSubstr("a.exr: cannot be written"));
  EXPECT_THAT(filesInFolder(), ElementsAre("a.exr"));
}

TEST_F(ImageFile, AWriteReplacesTheOldFileAndLeavesNoTemporary) {
  writeImage(folder_ / "a.png", makeRamp(4, 4));
  writeImage(folder_ / "a.png", makeRamp(2, 2));
  EXPECT_EQ(readImage(folder_ / "a.png").width, 2);
  EXPECT_THAT(filesInFolder(), ElementsAre("a.png"));
}

}  // namespace
}  // namespace oitlab
