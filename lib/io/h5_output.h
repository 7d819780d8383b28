// Writes HDF5 files that survive a crash and a full disk. Callers must hold an h5::Lock.
#pragma once

#include <cstdint>
#include <string>

#include "lib/io/h5.h"

namespace pbf::io_module::h5 {

/// File access for writers. Rows go to the disk at once, so that a full disk is noticed before
/// anything refers to them; what refers to them stays in memory until a flush, so that the file is
/// as the last flush left it.
Properties writer_access();

/// Writes what HDF5 holds in memory; the size of the file in bytes. HDF5 goes on after a failed
/// write and would leave a file that refers to what is not there, so the space is made sure of
/// first: nothing can fail after that. Failure with the system's reason.
std::int64_t flush_reserved(hid_t file);

/// Waits until the disk has stored the file's bytes and its size (fdatasync). Network file systems
/// and quotas report a full disk only here. Failure with the system's reason.
void sync(hid_t file);

/// The same for the names in a folder, which are not stored with the files. No error where the
/// file system has no such thing.
void sync_folder(const std::string& folder);

/// After a failure: HDF5 insists on writing what it still holds and can neither be told to forget
/// it nor end cleanly when it fails again (a full disk), so its descriptor is turned away from the
/// file. All that may follow is closing.
void abandon(hid_t file) noexcept;

}  // namespace pbf::io_module::h5
