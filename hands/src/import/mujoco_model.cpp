#include "import/mujoco_model.hpp"

#include <array>
#include <clocale>
#include <cstring>
#include <locale>
#include <mutex>

#include "graspfit/base/errors.hpp"

namespace graspfit::hands::internal {

namespace {

using base::IoError;
using Handler = void (*)(const char*);

/// Joins the lines of one of MuJoCo's messages.
std::string one_line(const std::string& text) {
  std::string line;
  bool is_break = false;
  for (const char c : text) {
    if (c == '\n' || c == '\r') {
      is_break = true;
      continue;
    }
    if (is_break && !line.empty()) line += line.back() == ':' ? " " : "; ";
    is_break = false;
    line += c;
  }
  return line;
}

/// The list for this thread's warnings; the handlers are the same for all threads.
thread_local std::vector<std::string>* warnings_of_this_thread = nullptr;
std::mutex handlers_mutex;
int num_handlers_wanted = 0;
Handler others_warning_handler = nullptr;
Handler others_error_handler = nullptr;

void take_warning(const char* message) {
  if (warnings_of_this_thread != nullptr) {
    warnings_of_this_thread->push_back(one_line(message));
  } else if (others_warning_handler != nullptr) {
    others_warning_handler(message);
  }
}

/// MuJoCo does not go on after an error: the error handler must not return.
void take_error(const char* message) {
  if (warnings_of_this_thread == nullptr && others_error_handler != nullptr) {
    others_error_handler(message);
  }
  throw MujocoError(one_line(message));
}

/// While such an object lives, new streams read numbers with decimal points. MuJoCo reads numbers
/// through streams of C++'s global locale; the locale of C's functions it handles itself. The
/// object does nothing in the usual program, whose global C++ locale is the classic one whatever
/// `setlocale` was called with.
class ClassicNumbers {
 public:
  ClassicNumbers() {
    const auto& numbers = std::use_facet<std::numpunct<char>>(before_);
    is_changed_ = numbers.decimal_point() != '.' || !numbers.grouping().empty();
    // A locale with a facet of its own has no name, so C's locale stays as it is.
    if (is_changed_) std::locale::global(std::locale(before_, new std::numpunct<char>));
  }
  ~ClassicNumbers() {
    if (!is_changed_) return;
    // A locale that has a name would set C's locale, too.
    const char* name = std::setlocale(LC_ALL, nullptr);
    const std::string c_locale = name ? name : "C";
    std::locale::global(before_);
    std::setlocale(LC_ALL, c_locale.c_str());
  }
  ClassicNumbers(const ClassicNumbers&) = delete;
  ClassicNumbers& operator=(const ClassicNumbers&) = delete;

 private:
  std::locale before_;  ///< The global C++ locale.
  bool is_changed_ = false;
};

std::mutex mutex;

MujocoModel load(const std::string& file, const mjVFS* files) {
  const std::lock_guard lock(mutex);
  MujocoModel result;
  const MujocoMessages messages;
  const ClassicNumbers numbers;
  std::array<char, 1000> message{};
  try {
    result.model.reset(
        mj_loadXML(file.c_str(), files, message.data(), static_cast<int>(message.size())));
  } catch (const std::exception& error) {  // MujocoError among others
    throw IoError(file + ": MuJoCo: " + error.what());
  }
  mj_freeLastXML();
  if (!result.model) throw IoError(file + ": MuJoCo: " + one_line(message.data()));
  result.warnings = messages.warnings();
  // The message is a warning of the model's compiler.
  if (message.front() != '\0') result.warnings.push_back(one_line(message.data()));
  return result;
}

}  // namespace

MujocoMessages::MujocoMessages() {
  const std::lock_guard lock(handlers_mutex);
  if (num_handlers_wanted++ == 0) {
    others_warning_handler = mju_user_warning;
    others_error_handler = mju_user_error;
    mju_user_warning = take_warning;
    mju_user_error = take_error;
  }
  warnings_of_this_thread = &warnings_;
}

MujocoMessages::~MujocoMessages() {
  const std::lock_guard lock(handlers_mutex);
  warnings_of_this_thread = nullptr;
  if (--num_handlers_wanted == 0) {
    mju_user_warning = others_warning_handler;
    mju_user_error = others_error_handler;
  }
}

MujocoModel load_mujoco_model(const std::filesystem::path& file) {
  return load(file.string(), nullptr);
}

MujocoModel load_mujoco_text(const std::string& name, const std::string& text) {
  const auto free_files = [](mjVFS* files) {
    mj_deleteVFS(files);
    delete files;
  };
  const std::unique_ptr<mjVFS, decltype(free_files)> files(new mjVFS, free_files);
  mj_defaultVFS(files.get());
  if (mj_makeEmptyFileVFS(files.get(), name.c_str(), static_cast<int>(text.size())) != 0) {
    throw IoError(name + ": MuJoCo takes no text of " + std::to_string(text.size()) + " bytes");
  }
  std::memcpy(files->filedata[0], text.data(), text.size());
  return load(name, files.get());
}

}  // namespace graspfit::hands::internal
