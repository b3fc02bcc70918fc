#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace graspfit::app {

/// A packed data set.
struct DatasetArchive {
  std::filesystem::path file;
  std::filesystem::path card;  ///< The data set's card with name, size and hash of the archive.
  std::int64_t size = 0;       ///< [bytes]
  std::string sha256;
};

/// Packs the data set in `folder` as gzipped tar: index, details, columns, configuration, manifest,
/// arrays, grasp files and card, in a folder of the data set's name, without times and owners, so
/// that the same data set gives the same bytes. Shards and journal are left out.
/// @throws InvalidInput if there is no finished data set in `folder`, IoError if it cannot be read
/// or the archive cannot be written; nothing half-written stays.
DatasetArchive pack_dataset(const std::filesystem::path& folder,
                            const std::filesystem::path& archive);

}  // namespace graspfit::app
