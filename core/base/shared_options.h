// Shared, immutable options for code that only copies them. They are kept by pointer, so that a file that
// copies them does not need their definition and is not rebuilt when they change.
#pragma once

#include <memory>
#include <utility>

namespace evical {

template <class Options>
class SharedOptions {
 public:
  SharedOptions() : options_(std::make_shared<const Options>()) {}  // the defaults

  const Options& operator*() const { return *options_; }
  const Options* operator->() const { return options_.get(); }
  SharedOptions& operator=(Options options) {
    options_ = std::make_shared<const Options>(std::move(options));
    return *this;
  }
  // Copies the options before a change. Do not keep the reference: later copies share it.
  Options& edit() {
    auto copy = std::make_shared<Options>(*options_);
    Options& own = *copy;
    options_ = std::move(copy);
    return own;
  }
  bool operator==(const SharedOptions& other) const {
    return options_ == other.options_ || *options_ == *other.options_;
  }

 private:
  std::shared_ptr<const Options> options_;  // immutable; replaced on change
};

}  // namespace evical
