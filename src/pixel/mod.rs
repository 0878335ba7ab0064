//! Pixels and what is in them: fragments, absorbance, the three depths, and the exact answer that everything else
//! approximates.

pub mod absorbance;
pub mod abuffer;
pub mod depth;
pub mod depth_warning;
pub mod filled;
pub mod fragment;
pub mod left_out;

pub use absorbance::{ABSORBANCE_MAX, absorbance, absorbance_lanes};
pub use depth::{CameraPlanes, DepthError, LogWarp, MomentDepth, ViewZ, WindowDepth};
pub use depth_warning::DepthWarning;
pub use filled::OfFilled;
pub use fragment::{Fragment, FragmentError, FragmentList, Pixel, Windows};
pub use left_out::LeftOut;
