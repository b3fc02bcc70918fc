#include "cli/interrupts.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

extern char** environ;

namespace graspfit::app {
namespace {

/// State that decides what the thread that waits for signals does when one comes.
struct InterruptState {
  std::mutex mutex;
  std::vector<std::pair<const CleanupOnInterrupt*, std::function<void()>>> cleanups;
  pid_t child = -1;
  std::optional<std::stop_source> stop;  ///< The stop that the first interrupt requests, if any.
  std::string stop_message;
  std::optional<int> heard;  ///< The signal that has requested the stop.
};

InterruptState& state() {
  // The state is never destroyed: the waiting thread outlives main's statics.
  static auto* const instance = new InterruptState;
  return *instance;
}

}  // namespace

void watch_interrupts() {
  sigset_t signals;
  sigemptyset(&signals);
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    sigaction(signal, nullptr, &action);
    // nohup and shells without job control start programs with these signals ignored; they stay
    // ignored.
    if (action.sa_handler != SIG_IGN) sigaddset(&signals, signal);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  state();
  std::thread([signals] {
    int signal = 0;
    for (;;) {
      if (sigwait(&signals, &signal) != 0) return;
      // If this interrupt ends the program, the lock is held to the end: threads that wait for it
      // do not go on.
      state().mutex.lock();
      if (!state().stop || state().heard) break;
      state().heard = signal;
      // On a terminal the current line shows progress, and what its driver shows of the interrupt.
      std::fprintf(stderr, "%s%s\n", isatty(STDERR_FILENO) != 0 ? "\n" : "",
                   state().stop_message.c_str());
      state().stop->request_stop();
      state().mutex.unlock();
    }
    if (state().child > 0) kill(-state().child, SIGTERM);
    for (auto last = state().cleanups.rbegin(); last != state().cleanups.rend(); ++last) {
      last->second();
    }
    _exit(128 + signal);
  }).detach();
}

void report_file_size_limit() {
  // If the signal is ignored, the write fails with EFBIG.
  struct sigaction action {};
  action.sa_handler = SIG_IGN;
  sigaction(SIGXFSZ, &action, nullptr);
}

CleanupOnInterrupt::CleanupOnInterrupt(std::function<void()> cleanup) {
  const std::lock_guard lock(state().mutex);
  state().cleanups.emplace_back(this, std::move(cleanup));
}

CleanupOnInterrupt::~CleanupOnInterrupt() {
  const std::lock_guard lock(state().mutex);
  std::erase_if(state().cleanups, [this](const auto& cleanup) { return cleanup.first == this; });
}

StopOnInterrupt::StopOnInterrupt(std::string message) {
  const std::lock_guard lock(state().mutex);
  state().stop.emplace();
  state().stop_message = std::move(message);
}

StopOnInterrupt::~StopOnInterrupt() {
  const std::lock_guard lock(state().mutex);
  state().stop.reset();
}

std::stop_token StopOnInterrupt::token() const {
  const std::lock_guard lock(state().mutex);
  return state().stop->get_token();
}

std::optional<int> interrupt_heard() {
  const std::lock_guard lock(state().mutex);
  return state().heard;
}

void without_interrupts(const std::function<void()>& work) {
  const std::lock_guard lock(state().mutex);
  work();
}

ProgramEnd run_program(const std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  int pipe_ends[2];
  if (pipe2(pipe_ends, O_CLOEXEC) != 0) return {127, "no pipe"};
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&files, pipe_ends[1], STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  // The program gets a process group of its own, so that an interrupt also reaches the programs
  // that it starts.
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  pid_t child = -1;
  int error = 0;
  without_interrupts([&] {
    error = posix_spawnp(&child, argv[0], &files, &attributes, argv.data(), environ);
    if (error == 0) state().child = child;
  });
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  close(pipe_ends[1]);

  ProgramEnd end;
  if (error != 0) {
    close(pipe_ends[0]);
    return {127, arguments[0] + ": " + std::strerror(error)};
  }
  char buffer[4096];
  for (;;) {
    const ssize_t count = read(pipe_ends[0], buffer, sizeof buffer);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    end.errors.append(buffer, static_cast<std::size_t>(count));
  }
  close(pipe_ends[0]);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  without_interrupts([] { state().child = -1; });
  end.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return end;
}

}  // namespace graspfit::app
