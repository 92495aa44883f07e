#include <cstring>
#include <vector>

#include <OpenEXR/IexBaseExc.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfVersion.h>

#include "image/codec.h"
#include "image/exr_header.h"
#include "util/error.h"
#include "util/suggest.h"

namespace oitlab {
namespace {

class MemoryInput : public Imf::IStream {
 public:
  MemoryInput(std::string_view bytes, const std::string& name)
      : IStream(name.c_str()), bytes_(bytes) {}

  bool read(char out[], int count) override {
    if (position_ > bytes_.size() || bytes_.size() - position_ < std::size_t(count))
      throw Iex::InputExc("the file ends too early");
    std::memcpy(out, bytes_.data() + position_, std::size_t(count));
    position_ += std::size_t(count);
    return position_ < bytes_.size();
  }
  std::uint64_t tellg() override { return position_; }
  void seekg(std::uint64_t position) override { position_ = position; }

 private:
  std::string_view bytes_;
  std::uint64_t position_ = 0;
};

class MemoryOutput : public Imf::OStream {
 public:
  explicit MemoryOutput(const std::string& name) : OStream(name.c_str()) {}

  void write(const char bytes[], int count) override {
    bytes_.resize(std::max<std::size_t>(bytes_.size(), position_ + std::size_t(count)));
    std::memcpy(bytes_.data() + position_, bytes, std::size_t(count));
    position_ += std::size_t(count);
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }

  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  std::uint64_t position_ = 0;
};

constexpr const char* rgbaChannels[] = {"R", "G", "B", "A"};

void checkChannel(const Imf::Channel& channel, const char* channelName, const std::string& name) {
  if (channel.type == Imf::UINT)
    fail<InputError>("{}: channel {} holds integers, wanted half or float", name, channelName);
  if (channel.xSampling != 1 || channel.ySampling != 1)
    fail<InputError>("{}: channel {} is subsampled {} x {}, wanted one value a pixel", name,
                     channelName, channel.xSampling, channel.ySampling);
}

/// Whether the file is grey (Y) and not RGB. Any other set of channels is an error: without a layer
/// or a chroma channel it would be another image.
bool isGrey(const Imf::ChannelList& channels, const std::string& name) {
  const bool rgb =
      channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B");
  const bool chroma = channels.findChannel("RY") || channels.findChannel("BY");
  if (!rgb && (chroma || !channels.findChannel("Y"))) {
    std::vector<std::string> found;
    for (auto it = channels.begin(); it != channels.end(); ++it) found.emplace_back(it.name());
    fail<InputError>("{}: channels {}, wanted R, G, B or Y", name, joinNames(found));
  }
  for (const char* wanted : {"R", "G", "B", "A"})
    if (const Imf::Channel* channel = channels.findChannel(wanted);
        channel && (rgb || *wanted == 'A'))
      checkChannel(*channel, wanted, name);
  if (!rgb) checkChannel(*channels.findChannel("Y"), "Y", name);
  return !rgb;
}

Image readPixels(Imf::InputFile& file, const std::string& name) {
  const Imath::Box2i window = file.header().dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1;
  const std::int64_t height = std::int64_t(window.max.y) - window.min.y + 1;
  checkImageSize(width, height, name);
  const bool grey = isGrey(file.header().channels(), name);

  Image image;
  image.width = int(width);
  image.height = int(height);
  image.rgba.resize(std::size_t(width) * height * 4);
  Imf::FrameBuffer frame;
  const auto insert = [&](const char* channel, int component) {
    // A missing channel is filled with 1. Only alpha may be missing.
    frame.insert(channel,
                 Imf::Slice::Make(Imf::FLOAT, image.rgba.data() + component, window,
                                  4 * sizeof(float), 4 * sizeof(float) * width, 1, 1, 1.0));
  };
  insert("A", 3);
  if (grey) {
    insert("Y", 0);
  } else {
    for (int c = 0; c < 3; ++c) insert(rgbaChannels[c], c);
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);

  if (grey)
    for (std::size_t i = 0; i < image.rgba.size(); i += 4)
      image.rgba[i + 1] = image.rgba[i + 2] = image.rgba[i];
  return image;
}

}  // namespace

Image decodeExr(std::string_view bytes, const std::string& name) {
  if (bytes.size() < 4 || !Imf::isImfMagic(bytes.data()))
    fail<InputError>("{}: not an OpenEXR file (it does not begin with the EXR signature)", name);
  checkExrHeader(bytes, name);
  try {
    MemoryInput stream(bytes, std::filesystem::path(name).filename().string());
    Imf::InputFile file(stream);
    return readPixels(file, name);
  } catch (const Iex::BaseExc& error) {
    fail<InputError>("{}: bad EXR: {}", name, error.what());
  }
}

std::string encodeExr(const Image& image, const std::string& name) {
  std::vector<float> linear = image.rgba;
  if (image.srgb)
    for (std::size_t i = 0; i < linear.size(); i += 4)
      for (int c = 0; c < 3; ++c) linear[i + c] = srgbDecode(linear[i + c]);

  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::FrameBuffer frame;
  for (int c = 0; c < 4; ++c) {
    header.channels().insert(rgbaChannels[c], Imf::Channel(Imf::FLOAT));
    frame.insert(rgbaChannels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(linear.data() + c),
                                             4 * sizeof(float), 4 * sizeof(float) * image.width));
  }
  try {
    MemoryOutput stream(name);
    {
      // The library writes the table of line offsets when the file is closed.
      Imf::OutputFile file(stream, header);
      file.setFrameBuffer(frame);
      file.writePixels(image.height);
    }
    return stream.take();
  } catch (const Iex::BaseExc& error) {
    fail<InputError>("{}: cannot be encoded as EXR: {}", name, error.what());
  }
}

}  // namespace oitlab
