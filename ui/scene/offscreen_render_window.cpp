// SPDX-License-Identifier: GPL-3.0-or-later
#include <GL/glew.h>  // before any other header that brings OpenGL

#include "ui/scene/offscreen_render_window.h"

#include <vtkObjectFactory.h>
#include <vtkRect.h>

#include <array>
#include <utility>

namespace evical::ui {

vtkStandardNewMacro(OffscreenRenderWindow);

OffscreenRenderWindow::OffscreenRenderWindow() {
  FrameBlitMode = NoBlit;
  OwnContext = 1;
  MultiSamples = 0;  // in software it takes several times the rest of the frame
}

// Here, since the base class's destructor cannot call our MakeCurrent().
OffscreenRenderWindow::~OffscreenRenderWindow() {
  if (!context_) return;
  const EglContext::Scope scope(*context_);
  Finalize();
}

void OffscreenRenderWindow::MakeCurrent() {
  if (context_) context_->makeCurrent();
}

bool OffscreenRenderWindow::IsCurrent() {
  return context_ && context_->isCurrent();
}

void OffscreenRenderWindow::OpenGLInit() {
  OpenGLInitContext();
  if (Initialized) OpenGLInitState();
}

// The base class asks OpenGL for its version before its functions are loaded, and accepts GLEW's result if
// that, built for GLX, finds no GLX display: all functions are loaded by then.
void OffscreenRenderWindow::OpenGLInitContext() {
  if (Initialized) return;
  ContextCreationTime.Modified();
  const GLenum loaded = glewInit();
  GlewInitValid = (loaded == GLEW_OK || loaded == GLEW_ERROR_NO_GLX_DISPLAY) && GLEW_VERSION_3_2;
  Initialized = GlewInitValid;
  if (!Initialized) return;
  std::array<GLfloat, 2> widths = {1.0F, 1.0F};
  glGetFloatv(GL_ALIASED_LINE_WIDTH_RANGE, widths.data());
  MaximumHardwareLineWidth = widths[1];
}

QImage OffscreenRenderWindow::drawImage(const QSize& size_px) {
  if (!context_) return {};
  const EglContext::Scope scope(*context_);
  if (!scope.current()) return {};
  if (GetSize()[0] != size_px.width() || GetSize()[1] != size_px.height()) {
    SetSize(size_px.width(), size_px.height());
  }
  Render();
  QImage image(size_px, QImage::Format_RGB32);
  ReadPixels(vtkRecti(0, 0, size_px.width(), size_px.height()), 1, GL_BGRA, GL_UNSIGNED_BYTE, image.bits(),
             0);
  return std::move(image).mirrored();
}

}  // namespace evical::ui
