// SPDX-License-Identifier: GPL-3.0-or-later
// VTK render window without a window: draws in an EglContext and returns the picture. For sources that draw
// with VTK; not for headers that Qt's moc reads.
#pragma once

#include "ui/scene/egl_context.h"

#include <vtkGenericOpenGLRenderWindow.h>

#include <QImage>

#include <memory>

namespace evical::ui {

class OffscreenRenderWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static OffscreenRenderWindow* New();
  vtkTypeMacro(OffscreenRenderWindow, vtkGenericOpenGLRenderWindow);

  void setContext(std::shared_ptr<EglContext> context) { context_ = std::move(context); }

  // Draws the scene and reads it back; a null image if the context cannot be made current.
  QImage drawImage(const QSize& size_px);

  void MakeCurrent() override;
  bool IsCurrent() override;
  void OpenGLInit() override;
  void OpenGLInitContext() override;

 protected:
  OffscreenRenderWindow();
  ~OffscreenRenderWindow() override;

 private:
  std::shared_ptr<EglContext> context_;
};

}  // namespace evical::ui
