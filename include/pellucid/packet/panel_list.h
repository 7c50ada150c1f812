// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "pellucid/segment/bounded.h"

namespace pellucid {

/// Panels of a ray, front to back: those that are done wait for those in front of them. A cut panel
/// becomes two. A list in an array: nothing is allocated.
class PanelList {
 public:
  struct Panel {
    int chunk, lane;    ///< its cell
    double begin, end;  ///< in [0, 1] of the way through it
    int cuts;           ///< how often it was cut off
    bool done;
    SegmentResult<double> segment;
    double length;                     ///< world
    double error;                      ///< as of RayBudget::spend()
    double from_opacity, from_length;  ///< its shares of the budget
    bool proved, nodes;
    int next;
  };
  static constexpr int capacity = 256;

  PanelList() noexcept { clear(); }
  void clear() noexcept {
    for (int i = 0; i < capacity; ++i) panel_[i].next = i + 1 < capacity ? i + 1 : -1;
    free_ = 0;
    front_ = back_ = -1;
    count_ = 0;
  }

  int room() const noexcept { return capacity - count_; }
  int front() const noexcept { return front_; }
  int next(int index) const noexcept { return panel_[index].next; }
  Panel& operator[](int index) noexcept { return panel_[index]; }

  /// At the end; there must be room.
  void append(int chunk, int lane, double begin, double end) noexcept {
    const int index = take();
    start(panel_[index], chunk, lane, begin, end, 0);
    panel_[index].next = -1;
    (back_ < 0 ? front_ : panel_[back_].next) = index;
    back_ = index;
  }
  /// Two in place of one, at a place strictly inside of it; there must be room.
  void cut(int index, double at) noexcept {
    const int behind = take();
    Panel& panel = panel_[index];
    start(panel_[behind], panel.chunk, panel.lane, at, panel.end, panel.cuts + 1);
    panel_[behind].next = panel.next;
    start(panel, panel.chunk, panel.lane, panel.begin, at, panel.cuts + 1);
    panel.next = behind;
    if (back_ == index) back_ = behind;
  }
  void remove_front() noexcept {
    const int index = front_;
    front_ = panel_[index].next;
    if (front_ < 0) back_ = -1;
    panel_[index].next = free_;
    free_ = index;
    --count_;
  }

 private:
  static void start(Panel& panel, int chunk, int lane, double begin, double end,
                    int cuts) noexcept {
    panel.chunk = chunk;
    panel.lane = lane;
    panel.begin = begin;
    panel.end = end;
    panel.cuts = cuts;
    panel.done = false;
  }
  int take() noexcept {
    const int index = free_;
    free_ = panel_[index].next;
    ++count_;
    return index;
  }

  Panel panel_[capacity];
  int free_, front_, back_, count_;
};

}  // namespace pellucid
