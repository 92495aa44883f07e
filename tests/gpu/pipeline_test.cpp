// Pipelines: the message for one that a driver refuses.
#include "gpu/pipeline.h"

#include <gtest/gtest.h>

namespace oitlab::testing {
namespace {

TEST(PipelineRefusal, NamesShadersDefinesCauseAndRemedy) {
  EXPECT_EQ(pipelineRefusal("GPU", {"a.vert", "b.frag"}, {{"N", "9"}, {"SORT", "1"}}, {},
                            "ErrorUnknown", "lower 'n'"),
            "GPU makes no pipeline of shaders/a.vert and shaders/b.frag (N=9, SORT=1): "
            "ErrorUnknown; lower 'n'");
  EXPECT_EQ(pipelineRefusal("GPU", {"c.comp"}, {}, {7, 8}, "ErrorUnknown", ""),
            "GPU makes no pipeline of shaders/c.comp (constant 0=7, constant 1=8): ErrorUnknown");
}

}  // namespace
}  // namespace oitlab::testing
