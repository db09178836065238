#include "core/frames/board_finder.h"
#include "core/frames/corner_measurement.h"
#include "core/frames/picture_view.h"
#include "core/frames/plane_map.h"
#include "core/geometry/tag_layout.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace evical {
namespace {

constexpr std::array<int, 2> kBorders = {2, 1};  // bits; Kalibr's first

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
      for (std::size_t corner = 0; corner < kTagCornerCount; ++corner)  // from the bottom left, CCW
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
  TagGridFinder(const Board& board, const FrameOptions& options)
      : board_(board), options_(options), possible_(distinctLayouts(board)) {
    for (const int border : kBorders) {
      readers_.emplace(border, border);
      patterns_.emplace(border, tagGridCorners(board, border));
    }
    if (options.tag_border == TagBorder::One) border_ = 1;
    if (options.tag_border == TagBorder::Two) border_ = 2;
  }

  FoundPoints search(const GrayImage& image) override {
    const std::vector<SeenTag> tags = tagsOfBoard(image);
    if (tags.empty() || !findLayout(tags)) return {};
    const std::vector<ReadPoint> corners = cornersOnBoard(tags);
    const std::vector<ReadPoint> agreeing =
        agreeingPoints(corners, board_.spacing_m / board_.tag_size_m * largestSide_px(tags));
    countMisfit(corners, agreeing);
    const std::optional<PlaneMap> map = mapOf(agreeing, board_.spacing_m);
    if (!map) return {};
    FoundPoints found = spread(image, *map);
    ++(found.empty() ? unmeasured_ : measured_);
    return found;
  }

  FoundPoints measure(const GrayImage& image, const PlaneMap& map, double gate_px) const override {
    return measureCorners(image, board_, patterns_.at(border_ == 0 ? kBorders[0] : border_), map, gate_px,
                          options_);
  }

  bool renumbered() override { return std::exchange(renumbered_, false); }

  std::string doubt() const override {
    constexpr int kEnoughPictures = 3;
    if (mirrored_ >= kEnoughPictures && largest_id_ < 0)
      return "the tags can only be read in the mirror image: the camera's pictures or the printed board are "
             "mirrored";
    if (largest_id_ >= 0)
      if (const std::string others = otherTagsText(board_, smallest_id_, largest_id_); !others.empty())
        return others;
    if (misfits_ >= kEnoughPictures && misfits_ > fits_)
      return fmt::format("the detected tags do not fit a board of {} x {} tags: check rows and columns",
                         board_.rows, board_.cols);
    if (looks_ >= kEnoughPictures && 2 * other_border_ > looks_)
      return fmt::format("a tag border of {} bit{} fits better than one of {}", border_ == 1 ? 2 : 1,
                         border_ == 1 ? "s" : "", border_);
    if (unmeasured_ >= kEnoughPictures && measured_ == 0)
      return "the tags were detected, but not the small squares between them that Kalibr's boards have and "
             "that corners are measured with";
    return {};
  }

  std::string remark() const override { return layoutRemark(layout_); }

 private:
  std::vector<SeenTag> readTags(const GrayImage& image) {
    if (border_ != 0) {
      std::vector<SeenTag> tags = readers_.at(border_).read(image);
      // If the requested border detects fewer tags, the other one may be correct: it is reported.
      const bool asked = options_.tag_border != TagBorder::Automatic;
      if (asked && looks_ < kMaxLooks) {
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

  int tagCount() const { return board_.rows * board_.cols; }

  std::vector<SeenTag> tagsOfBoard(const GrayImage& image) {
    std::vector<SeenTag> tags = readTags(image);
    if (tags.empty()) lookInMirror(image);
    for (const SeenTag& tag : tags) {
      largest_id_ = std::max(largest_id_, tag.id);
      smallest_id_ = std::min(smallest_id_, tag.id);
    }
    for (SeenTag& tag : tags) tag.id -= board_.first_tag;
    std::erase_if(tags, [&](const SeenTag& tag) { return tag.id < 0 || tag.id >= tagCount(); });
    return tags;
  }

  // A mirrored tag is not a tag of the family.
  void lookInMirror(const GrayImage& image) {
    if (largest_id_ >= 0 || mirror_looks_++ >= kMaxLooks) return;
    GrayImage mirrored{image.size_px, std::vector<std::uint8_t>(image.pixels.size())};
    cv::Mat picture(image.size_px.height_px, image.size_px.width_px, CV_8UC1, mirrored.pixels.data());
    cv::flip(viewOf(image), picture, 1);
    for (const int border : kBorders)
      if (readers_.at(border).read(mirrored).size() > 1) {
        ++mirrored_;
        return;
      }
  }

  TagCorners placeOf(const TagLayout& layout, int tag) const {
    const int first = kTagCornerCount * squareOf(board_, layout.order, tag);
    TagCorners square;
    for (int k = 0; k < kTagCornerCount; ++k)
      square.at(static_cast<std::size_t>(k)) = board_.point_m(first + k);
    return rotatedCorners(square, layout.quarter_turns);
  }

  // The layouts that agree best with the tags, in the order of the possible ones; none if no layout agrees.
  std::vector<TagLayout> agreeingLayouts(const std::vector<SeenTag>& tags) const {
    std::vector<double> agreements;
    for (const TagLayout& layout : possible_) {
      std::vector<TagCorners> places;
      for (const SeenTag& tag : tags) places.push_back(placeOf(layout, tag.id));
      agreements.push_back(agreementOfNeighbours(tags, places, options_.tag_neighbour_error));
    }
    const double best = *std::max_element(agreements.begin(), agreements.end());
    std::vector<TagLayout> agreeing;
    for (std::size_t k = 0; k < possible_.size(); ++k)
      if (best >= options_.min_tag_agreement && agreements[k] >= best - options_.same_tag_agreement)
        agreeing.push_back(possible_[k]);
    return agreeing;
  }

  // True if the tags can be placed on the board. The first picture that leaves only one layout decides.
  // Others, of one row of tags for example, are placed in Kalibr's if it is possible, also if no layout
  // agrees because tags are tiny or bent by the lens.
  bool findLayout(const std::vector<SeenTag>& tags) {
    if (layout_found_) return true;
    constexpr int kEnough = 3;
    const std::vector<TagLayout> agreeing = agreeingLayouts(tags);
    const bool enough = static_cast<int>(tags.size()) >= std::min(kEnough, tagCount());
    const bool usual = agreeing.empty() || agreeing.front() == TagLayout{};
    if (agreeing.size() != 1 || !enough) {
      placed_undecided_ = placed_undecided_ || usual;
      return usual;
    }
    layout_ = agreeing.front();
    layout_found_ = true;
    renumbered_ = placed_undecided_ && !usual;
    return true;
  }

  std::vector<ReadPoint> cornersOnBoard(const std::vector<SeenTag>& tags) const {
    std::vector<ReadPoint> corners;
    for (const SeenTag& tag : tags) {
      const TagCorners place = placeOf(layout_, tag.id);
      for (std::size_t k = 0; k < place.size(); ++k) corners.push_back({place[k], tag.corners_px[k]});
    }
    return corners;
  }

  // With wrong rows and columns, tags of several rows hardly fit one plane.
  void countMisfit(const std::vector<ReadPoint>& corners, const std::vector<ReadPoint>& agreeing) {
    constexpr std::size_t kEnoughTags = 4;
    if (corners.size() < kEnoughTags * kTagCornerCount) return;
    ++(5 * agreeing.size() < 4 * corners.size() ? misfits_ : fits_);
  }

  // From the decoded tags to their neighbours, until no more corners are found.
  FoundPoints spread(const GrayImage& image, const PlaneMap& from_tags) const {
    FoundPoints found = measure(image, from_tags, 2.0 * options_.max_move_px);
    constexpr int kMaxRounds = 4;
    for (int round = 0; round < kMaxRounds; ++round) {
      const std::optional<PlaneMap> map = mapOf(found, board_);
      if (!map) return {};
      FoundPoints more = measure(image, *map, options_.max_move_px);
      const bool grown = more.size() > found.size();
      found = std::move(more);
      if (!grown) break;
    }
    return found;
  }

  static constexpr int kMaxLooks = 20;

  Board board_;
  FrameOptions options_;
  std::map<int, TagReader> readers_;  // by border
  std::map<int, CornerPattern> patterns_;
  int border_ = 0;  // 0: unknown
  std::vector<TagLayout> possible_;
  TagLayout layout_;
  bool layout_found_ = false;
  bool placed_undecided_ = false;  // pictures were placed in Kalibr's layout before another one was found
  bool renumbered_ = false;
  int largest_id_ = -1, smallest_id_ = std::numeric_limits<int>::max(), fits_ = 0, misfits_ = 0;
  int measured_ = 0, unmeasured_ = 0;    // pictures with and without corners of the detected tags
  int mirror_looks_ = 0, mirrored_ = 0;  // pictures without tags, and those whose mirror image has tags
  int looks_ = 0, other_border_ = 0;     // number of tests of the other border, and of its better fits
};

}  // namespace

std::unique_ptr<PatternFinder> makeTagGridFinder(const Board& board, const FrameOptions& options) {
  return std::make_unique<TagGridFinder>(board, options);
}

}  // namespace evical
