#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace graspfit::exchange::internal {

/// Writes NumPy's NPZ: NPY files of version 1.0 in a ZIP archive, stored without compression and
/// without times, so that the same arrays give the same bytes [NumPy, "numpy.lib.format"; PKWARE,
/// APPNOTE.TXT 6.3]. Members stay below 4 GiB, as the archive has no ZIP64 records.
class NpzWriter {
 public:
  /// Little-endian doubles in C order; `shape` is empty for a single number. Precondition: as many
  /// values as the shape says.
  void add(std::string_view name, const std::vector<std::size_t>& shape,
           std::span<const double> values);

  /// Little-endian 64-bit integers; `shape` as above.
  void add(std::string_view name, const std::vector<std::size_t>& shape,
           std::span<const std::int64_t> values);

  /// Unicode texts of a common width; `shape` as above. Precondition: the texts are valid UTF-8
  /// (bytes that are not become U+FFFD).
  void add(std::string_view name, const std::vector<std::size_t>& shape,
           std::span<const std::string> texts);

  /// The archive. @throws InvalidInput above 4 GiB.
  std::string bytes() const;

 private:
  void add_member(std::string_view name, std::string_view type,
                  const std::vector<std::size_t>& shape, const std::string& data);

  std::string members_;    ///< Local headers and data.
  std::string directory_;  ///< Central directory.
  std::size_t count_ = 0;
};

}  // namespace graspfit::exchange::internal
