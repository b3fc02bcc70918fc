#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace graspfit::exchange::internal {

/// An array of an NPZ file, in C order; `shape` is empty for a single value.
template <class Value>
struct NpzArray {
  std::vector<std::size_t> shape;
  std::vector<Value> values;  ///< As many as the shape says.
};

/// Reads NumPy's NPZ: NPY files of versions 1 to 3 in a ZIP archive, stored or deflated [NumPy,
/// "numpy.lib.format"; PKWARE, APPNOTE.TXT 6.3].
///
/// Arrays are unpacked and checked when they are asked for; what nobody asks for may be anything.
/// Nothing is ever unpickled, and neither the file nor an array may be larger than 1 GiB. Every
/// message names the file and the array.
class NpzReader {
 public:
  /// Reads the file and its list of members. @throws IoError.
  explicit NpzReader(const std::filesystem::path& file);

  bool has(std::string_view name) const { return members_.count(std::string(name)) > 0; }

  /// Numbers of single or double precision or 32- or 64-bit integers, as doubles. Infinities and
  /// NaN are numbers here. @throws IoError if there is no such array, or it holds something else.
  NpzArray<double> numbers(std::string_view name) const;

  /// Texts, as UTF-8. @throws IoError as `numbers`.
  NpzArray<std::string> texts(std::string_view name) const;

  /// Throws IoError "FILE: PLACE: WHAT".
  [[noreturn]] void fail(std::string_view place, const std::string& what) const;

 private:
  struct Member {
    std::size_t offset = 0;       ///< Of the local header.
    std::size_t packed_size = 0;  ///< [bytes]
    std::size_t size = 0;         ///< [bytes]
    unsigned flags = 0;
    unsigned method = 0;
    unsigned long crc = 0;
  };
  /// The head of an NPY file, and what comes behind it.
  struct RawArray {
    std::string type;  ///< NumPy's `descr`: "<f8".
    std::vector<std::size_t> shape;
    std::size_t item_size = 0;  ///< [bytes]
    std::size_t count = 0;      ///< Product of the shape.
    std::string data;           ///< count · item_size bytes.
  };

  [[noreturn]] void fail(const std::string& what) const;
  void read_members();
  std::string unpacked(std::string_view name) const;
  RawArray raw_array(std::string_view name) const;

  std::string file_;  ///< For messages.
  std::string bytes_;
  std::map<std::string, Member> members_;  ///< By the array's name, without ".npy".
};

}  // namespace graspfit::exchange::internal
