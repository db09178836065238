#include "core/synthetic/pixel_array.h"
#include "core/synthetic/random.h"

#include <algorithm>
#include <vector>

namespace evical {
namespace {

constexpr int kMaxRoomSteps = 256;  // per interval

}  // namespace

void PixelArray::resetInRoom(const RigidTransform& world_from_camera, Scratch& scratch) {
  constexpr std::uint64_t kReferenceStream = 0xf0u;
  Random random(scenario_.seed, kReferenceStream + camera_);
  const RoomRenderer::Instant instant = room_->at(world_from_camera);
  for (int row = 0; row < renderer_.tileRows(); ++row)
    for (int column = 0; column < renderer_.tileColumns(); ++column) {
      const SceneRenderer::Tile tile = renderer_.tile(column, row);
      scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
      room_->look(tile, {&instant, &instant, &instant}, scratch.room_view);
      room_->render(instant, tile, scratch.room_view, scratch.input.data());
      for (int k = 0; k < tile.pixelCount(); ++k)
        settle(scratch.input[static_cast<std::size_t>(k)], static_cast<float>(random.uniform()),
               at(tile.x_px + k % tile.width_px, tile.y_px + k / tile.width_px));
    }
}

void PixelArray::beginInRoom(const std::function<RigidTransform(double)>& world_from_camera_at) {
  const auto instantAt = [&](double part) {
    return room_->at(world_from_camera_at(begin_s_ + part * (end_s_ - begin_s_)));
  };
  const RoomRenderer::Instant first = instantAt(0.0), middle = instantAt(0.5), last = instantAt(1.0);
  constexpr int kSamples = 8;  // per side: the fastest place is near one of them
  float travel_px = 0.0f;
  RoomRenderer::TileView view;
  for (int i = 0; i <= kSamples; ++i)
    for (int j = 0; j <= kSamples; ++j) {
      const int column = (renderer_.tileColumns() - 1) * i / kSamples, row = (tileRows() - 1) * j / kSamples;
      room_->look(renderer_.tile(column, row), {&first, &middle, &last}, view);
      travel_px = std::max(travel_px, view.travel_px);
    }
  int steps = minSteps(end_s_ - begin_s_);
  while (steps < kMaxRoomSteps && static_cast<float>(steps) * step_travel_px_ < travel_px) steps *= 2;
  room_instants_.clear();
  for (int k = 0; k <= steps; ++k) room_instants_.push_back(instantAt(static_cast<double>(k) / steps));
}

void PixelArray::runRoomRow(int tile_row, Scratch& scratch, std::vector<Event>& events) {
  const int all = static_cast<int>(room_instants_.size()) - 1;
  const RoomRenderer::Instants ends = {&room_instants_.front(), &room_instants_[room_instants_.size() / 2],
                                       &room_instants_.back()};
  const double length_s = end_s_ - begin_s_;
  for (int column = 0; column < renderer_.tileColumns(); ++column) {
    const SceneRenderer::Tile tile = renderer_.tile(column, tile_row);
    room_->look(tile, ends, scratch.room_view);
    int steps = minSteps(length_s);
    while (steps < all && static_cast<float>(steps) * step_travel_px_ < scratch.room_view.travel_px)
      steps *= 2;
    scratch.input.resize(static_cast<std::size_t>(tile.pixelCount()));
    for (int k = 1; k <= steps; ++k) {
      const Step step = stepBetween(begin_s_ + length_s * (k - 1) / steps, begin_s_ + length_s * k / steps);
      room_->render(room_instants_[static_cast<std::size_t>(k * (all / steps))], tile, scratch.room_view,
                    scratch.input.data());
      const float* input = scratch.input.data();
      for (int y = tile.y_px; y < tile.y_px + tile.height_px; ++y) {
        Pixel* pixel = &at(tile.x_px, y);
        for (int x = tile.x_px; x < tile.x_px + tile.width_px; ++x)
          advance(step, *input++ + step.lamp, x, y, *pixel++, events);
      }
    }
  }
}

}  // namespace evical
