#pragma once

#include <string>
#include <string_view>

namespace oitlab {

/// Checks the header of an EXR file, or each header where the file has several parts, before the
/// library reads it. The library allocates what a header asks for, up to 2 GiB for one attribute
/// and more for the table of lines, before it notices that the file holds less. Throws InputError
/// with `name` when an attribute ends behind the file, or the data window is not an image of
/// checkImageSize(). Format: "OpenEXR File Layout",
/// https://openexr.com/en/latest/OpenEXRFileLayout.html
void checkExrHeader(std::string_view bytes, const std::string& name);

}  // namespace oitlab
