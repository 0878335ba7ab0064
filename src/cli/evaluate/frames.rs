//! `nmt evaluate --frames`

use super::{Evaluate, Row, Session};
use crate::cli::scene::moving_scene;
use crate::evaluate::{OverTime, over_time};
use crate::oit::Method;
use crate::scene::CameraPath;
use std::ffi::OsStr;

/// An angle that turns a camera.
pub fn turn(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(degrees) if degrees != 0.0 && degrees.abs() <= 180.0 => Ok(degrees),
        _ => Err("expected an angle from -180 to 180 degrees, not 0".to_owned()),
    }
}

impl Evaluate {
    /// The way of the camera, where it moves.
    pub(super) fn path(&self) -> Option<CameraPath> {
        self.frames.map(|frames| CameraPath {
            frames,
            degrees_per_frame: self.degrees_per_frame,
        })
    }
}

impl Session<'_> {
    /// Adds to each row how its method changes from frame to frame, as the camera moves about the scene.
    pub(super) fn add_changes(&self, scene: &OsStr, rows: &mut [Row]) -> anyhow::Result<()> {
        let Some(path) = self.options.path() else { return Ok(()) };
        let applied: Vec<&dyn Method> = self
            .methods
            .iter()
            .map(|requested| &*requested.method)
            .filter(|method| rows.iter().any(|row| row.cpu.method == method.name()))
            .collect();
        let changes = self.changes(scene, path, &applied)?;
        for (method, change) in applied.iter().zip(changes) {
            let name = method.name();
            for row in rows.iter_mut().filter(|row| row.cpu.method == name) {
                row.cpu.over_time = change;
            }
        }
        Ok(())
    }

    fn changes(
        &self,
        name: &OsStr,
        path: CameraPath,
        methods: &[&dyn Method],
    ) -> anyhow::Result<Vec<Option<OverTime>>> {
        let scene = moving_scene(name)?;
        let options = self.options.options.for_scene();
        let progress = self.ui.progress("frames", path.frames.into());
        let frame = |i: u32| {
            progress.set(i.into(), name.to_string_lossy());
            Ok::<_, anyhow::Error>(path.build(&scene, &options, i)?)
        };
        let changes = over_time::measure(path.frames, frame, methods, self.context, self.background)?;
        progress.finish();
        Ok(changes)
    }

    /// What the heading of a table says of frames.
    pub(super) fn moving(&self, rows: &[Row]) -> String {
        let truth = rows.iter().find_map(|row| row.cpu.over_time?.truth_change_mse);
        match (self.options.path(), truth) {
            (Some(path), Some(truth)) => format!(
                "; {} frames, {} degrees a frame, the truth itself changes by {:.2e} (mean square)",
                path.frames, path.degrees_per_frame, truth
            ),
            _ => String::new(),
        }
    }
}
