#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "gpu/pipeline.h"

namespace oitlab {

/// A pipeline that is made when it is first asked for: many frames need few of a method's
/// pipelines, and drivers take their time (llvmpipe seconds).
class LazyPipeline {
 public:
  LazyPipeline() = default;
  explicit LazyPipeline(std::function<Pipeline()> make) : make_(std::move(make)) {}

  /// Whether there is one to make.
  explicit operator bool() const { return bool(make_); }

  /// Throws DeviceError when the driver refuses it.
  const Pipeline& operator*() const {
    if (!pipeline_) pipeline_ = make_();
    return *pipeline_;
  }

 private:
  std::function<Pipeline()> make_;
  mutable std::optional<Pipeline> pipeline_;
};

}  // namespace oitlab
