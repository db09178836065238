// SPDX-License-Identifier: GPL-3.0-or-later
#include "ui/scene/egl_context.h"

#include <QOpenGLContext>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstring>
#include <vector>

namespace evical::ui {
namespace {

// Devices first: a graphics card's own driver precedes the software renderer.
std::vector<EGLDisplay> candidateDisplays() {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto query_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  std::vector<EGLDisplay> displays;
  if (!get_display) return displays;
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (query_devices && query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
    for (EGLint i = 0; i < count; ++i) {
      displays.push_back(get_display(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr));
    }
  }
  displays.push_back(get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  return displays;
}

EGLContext createOn(EGLDisplay display) {
  if (!display || !eglInitialize(display, nullptr, nullptr)) return EGL_NO_CONTEXT;
  const char* const extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (!extensions || !std::strstr(extensions, "EGL_KHR_surfaceless_context")) return EGL_NO_CONTEXT;
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const std::array<EGLint, 5> config_attributes = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                                   EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  eglChooseConfig(display, config_attributes.data(), &config, 1, &count);
  const std::array<EGLint, 7> context_attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                                    3,
                                                    EGL_CONTEXT_MINOR_VERSION,
                                                    2,
                                                    EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                                    EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                                    EGL_NONE};
  return eglCreateContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT,
                          context_attributes.data());
}

}  // namespace

std::shared_ptr<EglContext> EglContext::create(std::string& problem) {
  const std::vector<EGLDisplay> displays = candidateDisplays();
  for (EGLDisplay display : displays) {
    const EGLContext handle = createOn(display);
    if (handle == EGL_NO_CONTEXT) continue;
    const std::shared_ptr<EglContext> context(new EglContext(display, handle));
    if (Scope(*context).current()) return context;
  }
  problem = displays.empty() ? "no EGL driver is installed" : "no EGL device offers OpenGL 3.2";
  return nullptr;
}

// The display is never terminated: that would destroy the contexts of other views.
EglContext::~EglContext() {
  if (isCurrent()) doneCurrent();
  eglDestroyContext(display_, context_);
}

bool EglContext::makeCurrent() {
  return eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE;
}

void EglContext::doneCurrent() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
}

bool EglContext::isCurrent() const {
  return eglGetCurrentContext() == context_;
}

EglContext::Scope::Scope(EglContext& context) : context_(context), entered_(!context.isCurrent()) {
  foreign_ = entered_ ? QOpenGLContext::currentContext() : nullptr;
  if (foreign_) {
    foreign_surface_ = foreign_->surface();
    foreign_->doneCurrent();
  }
  current_ = !entered_ || context_.makeCurrent();
}

EglContext::Scope::~Scope() {
  if (!entered_) return;
  context_.doneCurrent();
  if (foreign_) foreign_->makeCurrent(foreign_surface_);
}

}  // namespace evical::ui
