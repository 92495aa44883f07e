#pragma once

#include <string>

namespace oitlab {

/// Marks a device as measured on, so that a second run on this machine notices: two at once slow
/// each other down. The mark is a Unix socket with an abstract name, which no other process can
/// bind as long as this object lives, and which goes with the process, however that ends (unix(7)).
/// Containers with network namespaces of their own do not see each other's.
class DeviceClaim {
 public:
  /// `device`: what tells it from all others of the machine, Device::uuid().
  explicit DeviceClaim(const std::string& device);
  ~DeviceClaim();
  DeviceClaim(const DeviceClaim&) = delete;
  DeviceClaim& operator=(const DeviceClaim&) = delete;

  /// False where another process has marked the device. True where that cannot be known.
  bool take();

 private:
  std::string name_;
  int socket_ = -1;
};

}  // namespace oitlab
