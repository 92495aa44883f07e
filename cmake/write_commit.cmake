# Writes OUTPUT with the commit of SOURCE_DIR ("unknown" outside git) and a hash of its C++ source, only
# when one changed.
execute_process(COMMAND git -C ${SOURCE_DIR} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(commit "unknown")
endif()
# What measures: cells made by another source are measured again, and a commit of other files changes
# nothing in them.
file(GLOB_RECURSE sources RELATIVE ${SOURCE_DIR} ${SOURCE_DIR}/harness/* ${SOURCE_DIR}/methods/*)
list(FILTER sources EXCLUDE REGEX "^harness/cli/|\\.md$")
list(SORT sources)
set(hashes "")
foreach(source ${sources})
  file(SHA256 ${SOURCE_DIR}/${source} hash)
  string(APPEND hashes "${source} ${hash}\n")
endforeach()
string(SHA256 source_hash "${hashes}")
string(SUBSTRING ${source_hash} 0 16 source_hash)
set(text "#define OITLAB_COMMIT \"${commit}\"\n#define OITLAB_SOURCE \"${source_hash}\"\n")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT "${old}" STREQUAL "${text}")
  file(WRITE ${OUTPUT} "${text}")
endif()
