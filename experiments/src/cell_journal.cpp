#include "internal/cell_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>

#include "graspfit/geometry/atomic_file.hpp"
#include "graspfit/geometry/errors.hpp"

namespace graspfit::experiments::internal {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kChecksumDigits = 16;

std::string checked_line(const std::string& content) {
  return geometry::sha256_hex(content).substr(0, kChecksumDigits) + ' ' + content + '\n';
}

/// The content of a line without its line break, if its checksum is right.
std::optional<Json> checked_content(const std::string& line) {
  if (line.size() <= kChecksumDigits + 1) return std::nullopt;
  const std::string content = line.substr(kChecksumDigits + 1);
  if (checked_line(content) != line + '\n') return std::nullopt;
  Json json = Json::parse(content, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

}  // namespace

void CellJournal::fail(const std::string& what) const {
  throw geometry::IoError(file_.string() + ": " + what);
}

CellJournal::CellJournal(const std::filesystem::path& file,
                         const std::map<std::string, std::string>& identity, std::size_t num_cells)
    : file_(file), offsets_(num_cells, -1) {
  open_and_lock();
  try {
    load(identity);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

CellJournal::~CellJournal() { ::close(descriptor_); }

void CellJournal::open_and_lock() {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(std::strerror(errno));
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    ::close(descriptor_);
    fail(reason == EWOULDBLOCK ? "is in use by another run" : std::strerror(reason));
  }
}

void CellJournal::load(const std::map<std::string, std::string>& identity) {
  std::ifstream stream(file_, std::ios::binary);
  std::string line;
  bool has_header = false;
  // A last line without its line break was cut short: getline meets the end of the file.
  while (std::getline(stream, line) && !stream.eof()) {
    const std::int64_t offset = size_;
    size_ += static_cast<std::int64_t>(line.size()) + 1;
    const std::optional<Json> content = checked_content(line);
    if (!has_header) {
      if (!content || !content->is_object()) fail("is no file of finished cells; remove it");
      for (const auto& [what, value] : identity) {
        if (content->value(what, "") != value) {
          throw geometry::InvalidInput(file_.parent_path().string() +
                                       ": holds results of another " + what +
                                       "; remove the folder or choose another with --out");
        }
      }
      has_header = true;
    } else if (content && content->contains("cell")) {
      const auto cell = content->at("cell").get<std::size_t>();
      if (cell < offsets_.size()) offsets_[cell] = offset;
    }
  }
  if (::ftruncate(descriptor_, size_) != 0) fail(std::strerror(errno));
  if (!has_header) write_line(Json(identity).dump());
}

void CellJournal::write_line(const std::string& content) {
  const std::string line = checked_line(content);
  std::size_t written = 0;
  while (written < line.size()) {
    const ::ssize_t count = ::pwrite(descriptor_, line.data() + written, line.size() - written,
                                     static_cast<::off_t>(size_) + static_cast<::off_t>(written));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(std::strerror(errno));
    written += static_cast<std::size_t>(count);
  }
  if (::fsync(descriptor_) != 0) fail(std::strerror(errno));
  size_ += static_cast<std::int64_t>(line.size());
}

void CellJournal::append(std::size_t cell, const std::string& key, const CellRecord& record) {
  const Json content = {{"cell", cell},
                        {"key", key},
                        {"status", record.status},
                        {"reason", record.reason},
                        {"fields", record.fields},
                        {"timings", record.timings},
                        {"details", record.details}};
  const std::lock_guard lock(mutex_);
  const std::int64_t offset = size_;
  write_line(content.dump(-1, ' ', false, Json::error_handler_t::replace));
  offsets_[cell] = offset;
}

CellRecord CellJournal::read(std::size_t cell) const {
  std::ifstream stream(file_, std::ios::binary);
  stream.seekg(offsets_[cell]);
  std::string line;
  std::getline(stream, line);
  const std::optional<Json> content = checked_content(line);
  if (!content) fail("was changed while it was in use");
  return {content->at("status").get<std::string>(), content->at("reason").get<std::string>(),
          content->at("fields").get<std::vector<std::string>>(),
          content->at("timings").get<std::vector<std::string>>(),
          content->at("details").get<std::vector<std::vector<std::string>>>()};
}

}  // namespace graspfit::experiments::internal
