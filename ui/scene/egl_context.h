// SPDX-License-Identifier: GPL-3.0-or-later
// An OpenGL context without a window, which works on a desktop, under Xvfb and without any display.
#pragma once

#include <memory>
#include <string>

class QOpenGLContext;
class QSurface;

namespace evical::ui {

class EglContext {
 public:
  // Null if no EGL device provides OpenGL 3.2; `problem` is then the reason.
  static std::shared_ptr<EglContext> create(std::string& problem);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  bool makeCurrent();
  void doneCurrent();
  bool isCurrent() const;

  // Current for a scope. A context of Qt is released and restored: two kinds of contexts cannot be current in
  // one thread.
  class Scope {
   public:
    explicit Scope(EglContext& context);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;
    bool current() const { return current_; }

   private:
    EglContext& context_;
    bool entered_, current_;
    QOpenGLContext* foreign_ = nullptr;
    QSurface* foreign_surface_ = nullptr;
  };

 private:
  EglContext(void* display, void* context) : display_(display), context_(context) {}

  void *display_, *context_;  // EGLDisplay and EGLContext, whose header brings X11's macros with it
};

}  // namespace evical::ui
