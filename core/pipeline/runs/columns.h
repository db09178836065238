// Lossless conversion of structs to HDF5 datasets and back: a group for each struct, a dataset for each
// field. For a list of structs, each field is one column. Fields that are missing in a file keep their
// defaults.
#pragma once

#include "core/base/error.h"
#include "core/format/hdf5_content.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace evical::columns {

// Names and members of a struct.
template <class Struct>
struct Fields;

// clang-format off
#define EVICAL_ONCE(...) __VA_ARGS__
#define EVICAL_THRICE(...) EVICAL_ONCE(EVICAL_ONCE(EVICAL_ONCE(__VA_ARGS__)))
#define EVICAL_OFTEN(...) EVICAL_THRICE(EVICAL_THRICE(EVICAL_THRICE(EVICAL_THRICE(__VA_ARGS__))))
#define EVICAL_PARENTHESES ()
#define EVICAL_NEXT() EVICAL_EACH
#define EVICAL_EACH(NAME, ...) \
  std::pair{#NAME, &Struct::NAME} __VA_OPT__(, EVICAL_NEXT EVICAL_PARENTHESES (__VA_ARGS__))
// EVICAL_FIELDS(struct, its members in order): compilation fails if a member of the struct is missing here.
#define EVICAL_FIELDS(STRUCT, ...)                                         \
  template <>                                                              \
  struct Fields<STRUCT> {                                                  \
    using Struct = STRUCT;                                                 \
    static constexpr std::tuple kAll{EVICAL_OFTEN(EVICAL_EACH(__VA_ARGS__))}; \
    static void areAll(const Struct& all) {                                \
      const auto& [__VA_ARGS__] = all;                                     \
      static_cast<void>(std::tie(__VA_ARGS__));                            \
    }                                                                      \
  }
// clang-format on

// Last enumerator: larger numbers indicate damage.
template <class Enum>
inline constexpr Enum kLast = Enum{};

// Types that are not stored: each run takes them from its session.
template <class T>
inline constexpr bool kLeftOut = false;

// Count of numbers in a value of fixed size; 0 for other types.
template <class T>
inline constexpr int kWidth = 0;
template <class T, std::size_t Size>
inline constexpr int kWidth<std::array<T, Size>> = static_cast<int>(Size);
template <class T, int Rows, int Cols>
inline constexpr int kWidth<Eigen::Matrix<T, Rows, Cols>> = Rows == Eigen::Dynamic ? 0 : Rows* Cols;
template <>
inline constexpr int kWidth<Eigen::Quaterniond> = 4;

template <class T>
inline constexpr bool kIsOptional = requires(T& value) {
  value.has_value();
};
template <class T>
inline constexpr bool kIsMatrix = requires(T& value) {
  value.cols();
};
template <class T>
inline constexpr bool kIsSized = kIsOptional<T> || kIsMatrix<T> || requires(T& value) {
  value.emplace_back();
};

// Storage type of a column of numbers or texts.
template <class T>
using Stored = std::conditional_t<std::is_same_v<T, std::string>, std::string,
                                  std::conditional_t<std::is_floating_point_v<T>, double, std::int64_t>>;

inline CalibrationError damaged() {
  return badInput("", "is damaged");
}

class Writer {
 public:
  static constexpr bool kReads = false;
  explicit Writer(const Hdf5Sink& sink) : sink_(sink) {}

  template <class T>
  bool column(const std::string& path, std::size_t width, const std::vector<T*>& values) const {
    std::vector<Stored<std::remove_const_t<T>>> stored;
    stored.reserve(values.size());
    for (const T* value : values) stored.push_back(static_cast<Stored<std::remove_const_t<T>>>(*value));
    std::vector<std::size_t> shape = {values.size() / width};
    if (width > 1) shape.push_back(width);
    sink_({path, std::move(shape), std::move(stored), true});
    return true;
  }

 private:
  const Hdf5Sink& sink_;
};

// Throws CalibrationError (BadInput) if a column is not a valid value of its type.
class Reader {
 public:
  static constexpr bool kReads = true;
  Reader(const Hdf5Source& source, std::size_t most)
      : source_(source), left_(static_cast<std::int64_t>(most)) {}

  // False if it is absent.
  template <class T>
  bool column(const std::string& path, std::size_t, const std::vector<T*>& values) const {
    const std::optional<Hdf5Dataset> found = source_(path);
    if (!found) return false;
    const auto* const stored = std::get_if<std::vector<Stored<T>>>(&found->data);
    if (stored == nullptr || stored->size() != values.size()) throw damaged();
    for (std::size_t k = 0; k < values.size(); ++k) *values[k] = valueOf<T>((*stored)[k]);
    return true;
  }

  // The total length of all lists and matrices is limited to `most`.
  template <class T>
  void resize(T& value, std::int64_t rows, std::int64_t columns) {
    if (rows < 0 || columns < 0 || (columns > 0 && rows > left_ / columns)) throw damaged();
    left_ -= rows * columns;
    if constexpr (kIsMatrix<T>) {
      if (T::ColsAtCompileTime != Eigen::Dynamic && columns != T::ColsAtCompileTime) throw damaged();
      value.resize(rows, columns);
    } else if constexpr (!kIsOptional<T>) {
      value.resize(static_cast<std::size_t>(rows));
    } else {
      if (rows > 1) throw damaged();
      value.reset();
      if (rows == 1) value.emplace();
    }
  }

 private:
  template <class T>
  static T valueOf(const Stored<T>& stored) {
    if constexpr (std::is_enum_v<T>) {
      if (stored < 0 || stored > static_cast<std::int64_t>(kLast<T>)) throw damaged();
    } else if constexpr (std::is_same_v<T, bool>) {
      if (stored < 0 || stored > 1) throw damaged();
    } else if constexpr (std::is_integral_v<T>) {
      if (!std::in_range<T>(stored)) throw damaged();
    }
    return static_cast<T>(stored);
  }

  const Hdf5Source& source_;
  std::int64_t left_;
};

// Element type of a container or an optional.
template <class T>
auto spanOf(T& value) {
  if constexpr (kIsOptional<T>)
    return std::span(value ? &*value : nullptr, value ? 1 : 0);
  else if constexpr (std::is_same_v<std::remove_const_t<T>, Eigen::Quaterniond>)
    return std::span(value.coeffs().data(), 4);
  else
    return std::span(value.data(), static_cast<std::size_t>(value.size()));
}

template <class T>
auto itemsOf(const std::vector<T*>& values) {
  std::vector<decltype(spanOf(*values.front()).data())> items;
  for (T* const value : values)
    for (auto& item : spanOf(*value)) items.push_back(&item);
  return items;
}

template <class Io, class T>
bool visit(Io& io, const std::string& path, const std::vector<T*>& values);

template <class Io, class T>
bool visitSized(Io& io, const std::string& path, const std::vector<T*>& values) {
  std::vector<std::int64_t> rows, columns(values.size(), 1);
  for (T* const value : values) {
    rows.push_back(static_cast<std::int64_t>(spanOf(*value).size()));
    if constexpr (kIsMatrix<T>) {
      rows.back() = value->rows();
      columns[rows.size() - 1] = value->cols();
    }
  }
  if (!io.column(path + "/count", 1, itemsOf(std::vector{&rows}))) return false;
  if (kIsMatrix<T> && !io.column(path + "/columns", 1, itemsOf(std::vector{&columns}))) return false;
  if constexpr (Io::kReads)
    for (std::size_t k = 0; k < values.size(); ++k) io.resize(*values[k], rows[k], columns[k]);
  const auto items = itemsOf(values);
  if (items.empty()) return true;
  if constexpr (requires { Fields<std::remove_cvref_t<decltype(*items.front())>>::kAll; })
    return visit(io, path, items);
  else if (!visit(io, path + "/values", items))
    throw damaged();
  return true;
}

// One column, or several below `path`. False if there is none to be read.
template <class Io, class T>
bool visit(Io& io, const std::string& path, const std::vector<T*>& values) {
  using Value = std::remove_const_t<T>;
  if constexpr (kLeftOut<Value>) {
    return true;
  } else if constexpr (std::is_arithmetic_v<Value> || std::is_enum_v<Value> ||
                       std::is_same_v<Value, std::string>) {
    return io.column(path, 1, values);
  } else if constexpr (kWidth<Value> > 0) {
    return io.column(path, static_cast<std::size_t>(kWidth<Value>), itemsOf(values));
  } else if constexpr (kIsSized<Value>) {
    return visitSized(io, path, values);
  } else {
    const auto field = [&](const auto& named) {
      std::vector<decltype(&(values.front()->*named.second))> members;
      members.reserve(values.size());
      for (T* const value : values) members.push_back(&(value->*named.second));
      visit(io, path + "/" + named.first, members);
    };
    std::apply([&](const auto&... named) { (field(named), ...); }, Fields<Value>::kAll);
    return true;
  }
}

template <class T>
void write(const std::string& path, const T& value, const Hdf5Sink& sink) {
  Writer writer(sink);
  visit(writer, path, std::vector{&value});
}

// Throws CalibrationError (BadInput) if this is not such a value, or its lists are longer than `most` in
// total.
template <class T>
void read(const std::string& path, T& value, const Hdf5Source& source, std::size_t most) {
  Reader reader(source, most);
  visit(reader, path, std::vector{&value});
}

}  // namespace evical::columns
