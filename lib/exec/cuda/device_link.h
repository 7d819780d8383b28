// Exchanges of device memory between the ranks of a run: by NCCL, or through the host.
#pragma once

#include <cuda_runtime.h>

#include <memory>
#include <string>
#include <vector>

#include "lib/exec/ranks/communicator.h"

namespace pbf::exec_module {

class DeviceLink {
 public:
  virtual ~DeviceLink() = default;
  virtual std::string name() const = 0;  ///< "NCCL 2.28.3"
  /// Whether exchange() returns before the rows have arrived, which are then in the stream.
  virtual bool in_stream() const = 0;
  /// Behind what the stream has been given; pieces between two ranks are in the same order on both.
  virtual void exchange(const std::vector<Outgoing>& out, const std::vector<Incoming>& in,
                        cudaStream_t stream) = 0;
  /// Returns when the stream is done. Throws Error(unavailable) if another rank hangs.
  virtual void wait(cudaStream_t stream) = 0;
  /// The same for what was in a stream before the event.
  virtual void wait(cudaEvent_t event) = 0;
};

/// To be called on all ranks. NCCL, if every rank has the library and a device of its own; through
/// the host otherwise, or if the environment variable PBF_NCCL is "off".
std::unique_ptr<DeviceLink> make_device_link(Communicator& ranks);

/// Makes the device of this rank current: ranks of a machine take its devices in turns.
void use_device_of_rank(Communicator& ranks);

}  // namespace pbf::exec_module
