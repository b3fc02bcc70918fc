#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace graspfit::experiments::internal {

/// The last few values made, by key. Two threads that want the same new value may both make it.
template <class Value>
class LastUsed {
 public:
  template <class Make>
  std::shared_ptr<const Value> value(const std::string& key, const Make& make) {
    if (std::shared_ptr<const Value> kept = find(key)) return kept;
    auto made = std::make_shared<const Value>(make());
    const std::lock_guard lock(mutex_);
    values_.emplace_front(key, made);
    constexpr std::size_t kMost = 8;  // The hands of a sweep, or one object in their sizes.
    if (values_.size() > kMost) values_.pop_back();
    return made;
  }

 private:
  std::shared_ptr<const Value> find(const std::string& key) {
    const std::lock_guard lock(mutex_);
    for (auto entry = values_.begin(); entry != values_.end(); ++entry) {
      if (entry->first != key) continue;
      values_.splice(values_.begin(), values_, entry);
      return values_.front().second;
    }
    return nullptr;
  }

  std::mutex mutex_;
  std::list<std::pair<std::string, std::shared_ptr<const Value>>> values_;
};

}  // namespace graspfit::experiments::internal
