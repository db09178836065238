#include "core/frames/agreeing_points.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/pattern_finder.h"
#include "core/frames/picture_view.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace evical {
namespace {

constexpr int kCorners = 4;
constexpr std::array<int, 2> kBorders = {2, 1};  // bits; Kalibr's first

struct SeenTag {
  int id = 0;
  std::array<Eigen::Vector2d, kCorners> corners_px;  // from the bottom left, against the clock

  double side_px() const { return (corners_px[1] - corners_px[0]).norm(); }
};

double largestSide_px(const std::vector<SeenTag>& tags) {
  double side_px = 0.0;
  for (const SeenTag& tag : tags) side_px = std::max(side_px, tag.side_px());
  return side_px;
}

// One detector for tags with one width of border.
class TagReader {
 public:
  explicit TagReader(int border_bits)
      : family_(tag36h11_create(), tag36h11_destroy),
        detector_(apriltag_detector_create(), apriltag_detector_destroy) {
    const int more = border_bits - 1;  // bits more than in the family's definition
    family_->width_at_border += 2 * more;
    family_->total_width += 2 * more;
    for (std::uint32_t bit = 0; bit < family_->nbits; ++bit) {
      family_->bit_x[bit] += static_cast<std::uint32_t>(more);
      family_->bit_y[bit] += static_cast<std::uint32_t>(more);
    }
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), 1);
    detector_->nthreads = 1;
    detector_->refine_edges = true;
  }

  std::vector<SeenTag> read(const GrayImage& image) {
    constexpr int kManyPixels = 1'500'000;
    detector_->quad_decimate = image.size_px.pixelCount() > kManyPixels ? 2.0F : 1.0F;
    // Kalibr's tags touch the small squares between them, and the detector merges them: bright pixels are
    // dilated by one to the right and downwards. With this, 36 of 36 tags of rendered grids are detected
    // instead of 13.
    cv::Mat grown;
    cv::dilate(viewOf(image), grown, cv::Mat::ones(2, 2, CV_8UC1));
    const double shift_px = 0.5 + 0.5;  // dilation, and offset of pixel centres
    image_u8_t picture = {grown.cols, grown.rows, static_cast<int>(grown.step), grown.data};
    const std::unique_ptr<zarray_t, void (*)(zarray_t*)> detections(
        apriltag_detector_detect(detector_.get(), &picture), apriltag_detections_destroy);
    std::map<int, SeenTag> tags;
    std::set<int> twice;
    for (int k = 0; k < zarray_size(detections.get()); ++k) {
      apriltag_detection_t* seen = nullptr;
      zarray_get(detections.get(), k, static_cast<void*>(&seen));
      SeenTag tag;
      tag.id = seen->id;
      for (std::size_t corner = 0; corner < kCorners; ++corner)
        tag.corners_px.at(corner) =
            Eigen::Vector2d(seen->p[corner][0], seen->p[corner][1]).array() - shift_px;
      if (!tags.emplace(seen->id, tag).second) twice.insert(seen->id);
    }
    std::vector<SeenTag> clear;
    for (const auto& [id, tag] : tags)
      if (!twice.contains(id)) clear.push_back(tag);
    return clear;
  }

 private:
  std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family_;
  std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector_;
};

class TagGridFinder : public PatternFinder {
 public:
  TagGridFinder(const Board& board, const FrameOptions& options) : board_(board), options_(options) {
    for (const int border : kBorders) {
      readers_.emplace(border, border);
      patterns_.emplace(border, tagGridCorners(board, border));
    }
    if (options.tag_border == TagBorder::One) border_ = 1;
    if (options.tag_border == TagBorder::Two) border_ = 2;
  }

  FoundPoints search(const GrayImage& image) override {
    const std::vector<SeenTag> tags = readTags(image);
    const std::vector<ReadPoint> corners = cornersOnBoard(tags);
    if (corners.empty()) return {};
    const std::vector<ReadPoint> agreeing =
        agreeingPoints(corners, board_.spacing_m / board_.tag_size_m * largestSide_px(tags));
    countMisfit(corners, agreeing);
    const std::optional<PlaneMap> map = mapOf(agreeing, board_.spacing_m);
    return map ? spread(image, *map) : FoundPoints{};
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCorners(image, board_, patterns_.at(border_ == 0 ? kBorders[0] : border_), map, gate_px,
                          options_);
  }

  std::string doubt() const override {
    const int tags = board_.rows * board_.cols;
    if (largest_id_ >= tags)
      return fmt::format(
          "tag {} was detected, but a board of {} x {} tags has tags 0 to {}: check rows and columns",
          largest_id_, board_.rows, board_.cols, tags - 1);
    constexpr int kEnoughPictures = 3;
    if (misfits_ >= kEnoughPictures && misfits_ > fits_)
      return fmt::format("the detected tags do not fit a board of {} x {} tags: check rows and columns",
                         board_.rows, board_.cols);
    if (looks_ >= kEnoughPictures && 2 * other_border_ > looks_)
      return fmt::format("a tag border of {} bit{} fits better than one of {}", border_ == 1 ? 2 : 1,
                         border_ == 1 ? "s" : "", border_);
    return {};
  }

 private:
  std::vector<SeenTag> readTags(const GrayImage& image) {
    if (border_ != 0) {
      std::vector<SeenTag> tags = readers_.at(border_).read(image);
      // If the requested border detects fewer tags, the other one may be correct: it is reported.
      const bool asked = options_.tag_border != TagBorder::Automatic;
      if (asked && looks_ < kMostLooks) {
        ++looks_;
        other_border_ += readers_.at(border_ == 1 ? 2 : 1).read(image).size() > tags.size() ? 1 : 0;
      }
      return tags;
    }
    // Each reader may detect a few tags with the other border.
    std::vector<SeenTag> most;
    int border_of_most = 0;
    for (const int border : kBorders) {
      std::vector<SeenTag> tags = readers_.at(border).read(image);
      if (tags.size() <= most.size()) continue;
      most = std::move(tags);
      border_of_most = border;
    }
    const std::size_t needed = std::min<std::size_t>(2, static_cast<std::size_t>(board_.rows * board_.cols));
    if (most.size() < needed) return {};
    border_ = border_of_most;
    return most;
  }

  std::vector<ReadPoint> cornersOnBoard(const std::vector<SeenTag>& tags) {
    std::vector<ReadPoint> corners;
    for (const SeenTag& tag : tags) {
      largest_id_ = std::max(largest_id_, tag.id);
      if (tag.id >= board_.rows * board_.cols) continue;
      for (int k = 0; k < kCorners; ++k)
        corners.push_back(
            {board_.point_m(kCorners * tag.id + k), tag.corners_px.at(static_cast<std::size_t>(k))});
    }
    return corners;
  }

  // With wrong rows and columns, tags of several rows hardly fit one plane.
  void countMisfit(const std::vector<ReadPoint>& corners, const std::vector<ReadPoint>& agreeing) {
    constexpr std::size_t kEnoughTags = 4;
    if (corners.size() < kEnoughTags * kCorners) return;
    ++(5 * agreeing.size() < 4 * corners.size() ? misfits_ : fits_);
  }

  // From the decoded tags to their neighbours, until no more corners are found.
  FoundPoints spread(const GrayImage& image, const PlaneMap& from_tags) const {
    FoundPoints found = measure(image, from_tags, 2.0 * options_.largest_move_px);
    constexpr int kMostRounds = 4;
    for (int round = 0; round < kMostRounds; ++round) {
      const std::optional<PlaneMap> map = mapOf(found, board_);
      if (!map) return {};
      FoundPoints more = measure(image, *map, options_.largest_move_px);
      const bool grown = more.size() > found.size();
      found = std::move(more);
      if (!grown) break;
    }
    return found;
  }

  static constexpr int kMostLooks = 20;

  Board board_;
  FrameOptions options_;
  std::map<int, TagReader> readers_;  // by border
  std::map<int, CornerPattern> patterns_;
  int border_ = 0;  // 0: unknown
  int largest_id_ = -1, fits_ = 0, misfits_ = 0;
  int looks_ = 0, other_border_ = 0;  // number of tests of the other border, and of its better fits
};

}  // namespace

std::unique_ptr<PatternFinder> makeTagGridFinder(const Board& board, const FrameOptions& options) {
  return std::make_unique<TagGridFinder>(board, options);
}

}  // namespace evical
