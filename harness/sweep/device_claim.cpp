#include "sweep/device_claim.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>

namespace oitlab {

DeviceClaim::DeviceClaim(const std::string& device) : name_("oitlab device " + device) {}

DeviceClaim::~DeviceClaim() {
  if (socket_ >= 0) close(socket_);
}

bool DeviceClaim::take() {
  if (socket_ >= 0) return true;
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  // The first byte stays 0: an abstract name.
  const std::size_t length = std::min(name_.size(), sizeof address.sun_path - 1);
  std::copy_n(name_.begin(), length, address.sun_path + 1);
  const int opened = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (opened < 0) return true;
  const auto size = socklen_t(offsetof(sockaddr_un, sun_path) + 1 + length);
  if (bind(opened, reinterpret_cast<const sockaddr*>(&address), size) == 0) {
    socket_ = opened;
    return true;
  }
  const bool taken = errno == EADDRINUSE;
  close(opened);
  return !taken;
}

}  // namespace oitlab
