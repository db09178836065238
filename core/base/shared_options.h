// Options that most code never looks at, so that it does not depend on them either: a value like any other, of a type that need
// not be known where it is only copied.
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
  bool operator==(const SharedOptions& other) const {
    return options_ == other.options_ || *options_ == *other.options_;
  }

 private:
  std::shared_ptr<const Options> options_;  // nobody changes them: they are replaced
};

}  // namespace evical
