// Output files: decides which are replaced as a whole, which are written directly and which are
// refused.
#pragma once

#include <string>
#include <string_view>

namespace pbf::base_module {

/// Prefix of the names of unfinished files.
inline constexpr const char* kTemporaryPrefix = ".pbf-";

/// Who chose the name of a file.
enum class Naming {
  given,  ///< the user: links are followed; pipes, FIFOs and devices are written to
  own     ///< the program, in a folder of results: only a regular file may be there
};

/// A file that is never visible half written. Bytes go to a file without a name, which replaces the
/// old file at the end. Pipes, FIFOs with a reader, devices and descriptors of this process
/// (/dev/stdout, /dev/fd/N) are written directly.
class OutputFile {
 public:
  /// Throws Error(io) if it cannot be created, Error(bad_input) for a file that the command reads.
  OutputFile(const std::string& path, Naming naming);
  ~OutputFile();  ///< without finish() the old file stays
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// For writers that need a descriptor. This object closes it.
  int descriptor() const { return fd_; }
  /// Throws Error(io). If the reader of a pipe has gone, the bytes are dropped without an error.
  void write(std::string_view bytes);
  /// Moves the file into place; with `stored` only once it is on the disk. Throws Error(io).
  void finish(bool stored);

 private:
  void give_name();
  [[noreturn]] void fail(const std::string& what, int reason);

  std::string path_, target_, folder_, temporary_;
  int fd_ = -1;
  bool straight_ = false, nameless_ = false;
};

/// Writes a text file as an OutputFile and waits until it is on the disk.
void write_text_file(const std::string& path, const std::string& text,
                     Naming naming = Naming::given);

/// Opens a file that grows line by line; links, pipes and devices are treated as by OutputFile. A
/// regular file is emptied, or continued with `append`. The caller closes the descriptor. Throws
/// Error(io), and Error(bad_input) for a file that the command reads.
int open_output_stream(const std::string& path, bool append);

/// Whether the path is a pipe, a FIFO, a device or a descriptor, which is written directly.
bool is_stream(const std::string& path);

/// Checks the file given with `option` before the work starts; does nothing for an empty path.
/// Throws Error(bad_input) if the command reads it, Error(io) if it could not be written.
void check_output(const std::string& option, const std::string& path);

/// Whether two paths name the same file. The files need not exist.
bool same_output(const std::string& a, const std::string& b);

/// As check_output() for two files, which must not be one: else Error(bad_input).
void check_outputs(const std::string& option, const std::string& path, const std::string& other,
                   const std::string& other_path);

}  // namespace pbf::base_module
