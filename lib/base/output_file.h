// Output files: decides which are replaced as a whole, which are written directly and which are
// refused.
#pragma once

#include <string>
#include <string_view>

namespace pbf::inline base_module {

/// How the names begin under which files wait for their place.
inline constexpr const char* kTemporaryPrefix = ".pbf-";

/// Who chose the name of a file.
enum class Naming {
  given,  ///< the user: links are followed; pipes, FIFOs and devices are written to
  own     ///< the program, in a folder of results: only a regular file may be there
};

/// A file that nobody sees half written: its bytes gather in a file without a name, which takes the
/// place of what is there at the end. Pipes, FIFOs with a reader, devices and descriptors of this
/// process (/dev/stdout, /dev/fd/N) get them straight.
class OutputFile {
 public:
  /// Throws Error(io) when it cannot be made, Error(bad_input) for a file that the command reads.
  OutputFile(const std::string& path, Naming naming);
  ~OutputFile();  ///< without finish() what was there stays
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// For writers that need one; it stays this object's.
  int descriptor() const { return fd_; }
  /// A pipe whose reader has gone takes no more, which is no error. Else Error(io).
  void write(std::string_view bytes);
  /// Puts the file into its place; `stored`: after the disk has it. Error(io).
  void finish(bool stored);

 private:
  void give_name();
  [[noreturn]] void fail(const std::string& what, int reason);

  std::string path_, target_, folder_, temporary_;
  int fd_ = -1;
  bool straight_ = false, nameless_ = false;
};

/// Writes a text file in this way and waits for the disk.
void write_text_file(const std::string& path, const std::string& text,
                     Naming naming = Naming::given);

/// Opens a file that grows line by line, with the same meaning of links, pipes and devices; a
/// regular file is emptied, or with `append` continued. The descriptor is the caller's. Throws
/// Error(io), and Error(bad_input) for a file that the command reads.
int open_output_stream(const std::string& path, bool append);

/// Whether what is written there cannot be replaced: a pipe, a FIFO, a device, a descriptor.
bool is_stream(const std::string& path);

/// Before the work, for the file given with `option` (none: an empty path): Error(bad_input) when
/// the command reads it, Error(io) when it could not be written at the end.
void check_output(const std::string& option, const std::string& path);

/// Whether two paths, of which neither need exist, name one file.
bool same_output(const std::string& a, const std::string& b);

}  // namespace pbf::inline base_module
