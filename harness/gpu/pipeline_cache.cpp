#include "gpu/pipeline_cache.h"

#include "image/hash.h"

namespace oitlab {

std::string PipelineKey::hash() const {
  return imageHash(std::as_bytes(std::span(text_)));
}

}  // namespace oitlab
