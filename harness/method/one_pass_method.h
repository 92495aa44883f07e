#pragma once

#include "method/make_source.h"

namespace oitlab {

/// A method that is one pass over all fragments: its constructor names the program, record() gives
/// recordPass() the push constants. Blended and exclusive programs leave the image in the target.
class OnePassMethod : public Method {
 public:
  bool usesComputeRasterizer() const override { return source_->usesComputeRasterizer(); }

  Status status() override {
    if (source_->grow()) return {.recordAgain = true};
    Status status;
    source_->addCounters(status.counters);
    return status;
  }

 protected:
  /// Throws what makeSource() and FragmentSource::make() throw.
  OnePassMethod(const MethodContext& context, const FragmentProgram& program)
      : source_(makeSource(context, program.dependsOnOrder())), pass_(source_->make(program)) {}

  /// Records the pass as stage `stage`. Fills in the first member of `push`, `frame`.
  template <typename Push>
  void recordPass(const Frame& frame, const std::string& stage, Push push,
                  const Submission& submission = {}) const {
    push.frame = source_->begin(frame, submission);
    source_->run(frame, stage, pass_, push);
    source_->end(frame);
  }

  /// The push constants of a program that needs no others.
  struct FrameOnly {
    std::uint64_t frame = 0;
  };

 private:
  std::unique_ptr<FragmentSource> source_;
  FragmentPass pass_;
};

}  // namespace oitlab
