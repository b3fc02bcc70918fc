#include "run/cell_journal.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <tuple>

#include "graspfit/base/errors.hpp"
#include "graspfit/base/sha256.hpp"

namespace graspfit::sweep::internal {
namespace {

using SortedJson = nlohmann::json;

constexpr std::size_t kChecksumDigits = 16;

std::string checked_line(const std::string& content) {
  return base::sha256_hex(content).substr(0, kChecksumDigits) + ' ' + content + '\n';
}

/// The content of a line without its line break, if its checksum is right.
std::optional<SortedJson> checked_content(const std::string& line) {
  if (line.size() <= kChecksumDigits + 1) return std::nullopt;
  const std::string content = line.substr(kChecksumDigits + 1);
  if (checked_line(content) != line + '\n') return std::nullopt;
  SortedJson json = SortedJson::parse(content, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

std::string text_of(const SortedJson& json) {
  return json.dump(-1, ' ', false, SortedJson::error_handler_t::replace);
}

double unix_time_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void read_header(const std::filesystem::path& file, const std::optional<SortedJson>& header,
                 JournalContent& content) {
  if (!header || !header->contains("identity") || !header->contains("num_cells")) {
    throw base::IoError(file.string() + ": is no file of finished cells; remove it");
  }
  content.identity = header->at("identity").get<JournalIdentity>();
  content.cells.resize(header->at("num_cells").get<std::size_t>());
  content.has_header = true;
}

void note_cell(const SortedJson& line, std::int64_t offset, JournalContent& content) {
  const auto cell = line.at("cell").get<std::size_t>();
  if (cell >= content.cells.size()) return;
  content.last_cell_s = line.at("at").get<double>();
  ++content.num_cells_since_start;
  const bool is_final = line.at("is_final").get<bool>();
  if (content.cells[cell].is_final && !is_final) return;
  content.cells[cell] = {offset, is_final, line.at("status") == "failed"};
}

void note_start(const SortedJson& line, JournalContent& content) {
  content.last_start_s = line.at("at").get<double>();
  content.num_cells_since_start = 0;
  for (const auto& [name, hash] : line.at("inputs").items()) content.inputs[name] = hash;
}

}  // namespace

JournalContent read_journal(const std::filesystem::path& file) {
  JournalContent content;
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  // A last line without its line break was cut short: getline meets the end of the file.
  while (std::getline(stream, line) && !stream.eof()) {
    const std::int64_t offset = content.size;
    content.size += static_cast<std::int64_t>(line.size()) + 1;
    const std::optional<SortedJson> json = checked_content(line);
    if (!content.has_header) {
      read_header(file, json, content);
    } else if (json && json->contains("cell")) {
      note_cell(*json, offset, content);
    } else if (json && json->contains("inputs")) {
      note_start(*json, content);
    }
  }
  return content;
}

bool is_journal_in_use(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_locked = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return is_locked;
}

void CellJournal::fail(const std::string& what) const {
  throw base::IoError(file_.string() + ": " + what);
}

CellJournal::CellJournal(const std::filesystem::path& file, const JournalIdentity& identity,
                         std::size_t num_cells)
    : file_(file) {
  open_and_lock();
  try {
    content_ = read_journal(file_);
    if (::ftruncate(descriptor_, content_.size) != 0) fail(std::strerror(errno));
    if (content_.has_header) {
      check_header(identity);
    } else {
      content_.identity = identity;
      content_.cells.resize(num_cells);
      write_line(SortedJson{{"identity", identity}, {"num_cells", num_cells}}.dump());
      flush_to_disk();
    }
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

CellJournal::~CellJournal() { ::close(descriptor_); }

void CellJournal::open_and_lock() {
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail(std::strerror(errno));
  // A process that asks whether a run is going holds the lock for a moment, too: see
  // is_journal_in_use.
  constexpr int kMostTries = 50;
  constexpr std::chrono::milliseconds kPause(10);
  for (int tries = 1; ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0; ++tries) {
    const int reason = errno;
    if (reason == EWOULDBLOCK && tries < kMostTries) {
      std::this_thread::sleep_for(kPause);
      continue;
    }
    ::close(descriptor_);
    fail(reason == EWOULDBLOCK ? "is in use by another run" : std::strerror(reason));
  }
}

void CellJournal::check_header(const JournalIdentity& identity) const {
  for (const auto& [what, value] : identity) {
    const auto own = content_.identity.find(what);
    if (own != content_.identity.end() && own->second == value) continue;
    throw base::InvalidInput(file_.parent_path().string() + ": holds results of another " + what +
                             "; remove the folder or choose another with --out");
  }
}

void CellJournal::write_line(const std::string& content) {
  const std::string line = checked_line(content);
  std::size_t written = 0;
  while (written < line.size()) {
    const ::ssize_t count =
        ::pwrite(descriptor_, line.data() + written, line.size() - written,
                 static_cast<::off_t>(content_.size) + static_cast<::off_t>(written));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail(std::strerror(errno));
    written += static_cast<std::size_t>(count);
  }
  content_.size += static_cast<std::int64_t>(line.size());
}

void CellJournal::flush_to_disk() {
  if (::fsync(descriptor_) != 0) fail(std::strerror(errno));
}

void CellJournal::start_run(const std::map<std::string, std::string>& inputs) {
  for (const auto& [name, hash] : inputs) {
    const auto earlier = content_.inputs.find(name);
    if (earlier == content_.inputs.end() || earlier->second == hash) continue;
    throw base::InvalidInput(file_.parent_path().string() + ": holds results of another " + name +
                             ", which has changed since; remove the folder or choose " +
                             "another with --out");
  }
  const SortedJson line = {{"inputs", inputs}, {"at", unix_time_s()}};
  write_line(text_of(line));
  flush_to_disk();
  note_start(line, content_);
}

void CellJournal::append(std::size_t cell, const std::string& key, const CellRecord& record) {
  SortedJson line = {{"cell", cell},
                     {"key", key},
                     {"status", record.status},
                     {"is_final", record.is_final},
                     {"reason", record.reason},
                     {"fields", record.fields},
                     {"timings", record.timings},
                     {"details", record.details}};
  const std::lock_guard lock(mutex_);
  line["at"] = unix_time_s();
  const std::int64_t offset = content_.size;
  write_line(text_of(line));
  flush_to_disk();
  note_cell(line, offset, content_);
}

std::string CellJournal::line_of(std::size_t cell) const {
  std::ifstream stream(file_, std::ios::binary);
  stream.seekg(content_.cells[cell].offset.value());
  std::string line;
  std::getline(stream, line);
  if (!checked_content(line)) fail("was changed while it was in use");
  return line.substr(kChecksumDigits + 1);
}

CellRecord CellJournal::read(std::size_t cell) const {
  const SortedJson line = SortedJson::parse(line_of(cell));
  return {line.at("status").get<std::string>(),
          line.at("reason").get<std::string>(),
          line.at("fields").get<std::vector<std::string>>(),
          line.at("timings").get<std::vector<std::string>>(),
          line.at("details").get<std::vector<std::vector<std::string>>>(),
          line.at("is_final").get<bool>()};
}

void CellJournal::absorb(const CellJournal& other) {
  start_run(other.inputs());
  for (std::size_t i = 0; i < num_cells(); ++i) {
    if (has(i) && other.has(i)) {
      const CellRecord ours = read(i);
      const CellRecord theirs = other.read(i);
      if (std::tie(ours.status, ours.reason, ours.fields, ours.details) !=
          std::tie(theirs.status, theirs.reason, theirs.fields, theirs.details)) {
        throw base::InvalidInput(
            file_.string() + " and " + other.file_.string() + ": have different results of cell " +
            SortedJson::parse(line_of(i)).at("key").get<std::string>() + "; they must be the same");
      }
    } else if (other.has(i) || (other.is_known(i) && !is_known(i))) {
      const std::string line = other.line_of(i);
      const std::int64_t offset = content_.size;
      write_line(line);
      note_cell(SortedJson::parse(line), offset, content_);
    }
  }
  flush_to_disk();
}

}  // namespace graspfit::sweep::internal
