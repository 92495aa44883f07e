#include "gpu/struct_size.h"

#include <map>
#include <set>

#include <glslang/SPIRV/spirv.hpp>

#include "util/check.h"
#include "util/error.h"
#include "util/rounding.h"

namespace oitlab {
namespace {

struct Size {
  std::uint64_t bytes = 0, alignment = 1;
};

Size times(const Size& element, std::uint64_t count) {
  return {element.bytes * count, element.alignment};
}

}  // namespace

std::uint64_t structBytes(std::span<const std::uint32_t> words, std::string_view name) {
  // Types and constants come before their first use (SPIR-V specification, section 2.4), so one
  // walk is enough. An instruction is a word of its length and operation, and its operands.
  constexpr std::size_t headerWords = 5;
  std::set<std::uint32_t> named;
  std::map<std::uint32_t, std::uint32_t> constants;
  std::map<std::uint32_t, Size> types;
  for (std::size_t at = headerWords; at < words.size();) {
    const std::uint32_t* operand = &words[at + 1];
    const std::size_t length = words[at] >> spv::WordCountShift;
    OITLAB_CHECK(length > 0 && at + length <= words.size());
    switch (words[at] & spv::OpCodeMask) {
      case spv::OpName:
        if (reinterpret_cast<const char*>(operand + 1) == name) named.insert(operand[0]);
        break;
      case spv::OpConstant:
        constants[operand[1]] = operand[2];
        break;
      case spv::OpTypeBool:
        types[operand[0]] = {4, 4};
        break;
      case spv::OpTypeInt:
      case spv::OpTypeFloat:
        types[operand[0]] = {operand[1] / 8, operand[1] / 8};
        break;
      case spv::OpTypeVector:
      case spv::OpTypeMatrix:
        types[operand[0]] = times(types[operand[1]], operand[2]);
        break;
      case spv::OpTypeArray:
        types[operand[0]] = times(types[operand[1]], constants[operand[2]]);
        break;
      case spv::OpTypeForwardPointer:  // buffer references
      case spv::OpTypePointer:
        types[operand[0]] = {8, 8};
        break;
      case spv::OpTypeStruct: {
        Size& size = types[operand[0]];
        for (std::size_t i = 1; i + 1 < length; ++i) {
          const Size& member = types[operand[i]];
          size.alignment = std::max(size.alignment, member.alignment);
          size.bytes = roundUp(size.bytes, member.alignment) + member.bytes;
        }
        size.bytes = roundUp(size.bytes, size.alignment);
        if (named.contains(operand[0])) return size.bytes;
        break;
      }
      default:
        break;
    }
    at += length;
  }
  fail<InputError>("the shader has no structure {}", name);
}

}  // namespace oitlab
