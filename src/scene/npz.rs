//! The fragment list as an `.npz` file: the exchange format for pixels of any renderer.
//!
//! `offsets` u32 or u64 `[P + 1]`, `view_z` f32 `[F]`, `alpha` f32 `[F]`; optional `color` f32 `[F, 3]`, `width`, `height`, `near`, `far`.

use super::SceneError;
use crate::numeric::file::{FileError, Replace};
use crate::numeric::npy::{Element, NpyError, Npz, encode, write_npz};
use crate::pixel::{CameraPlanes, FragmentError, FragmentList};
use ndarray::{ArrayView1, ArrayView2, arr0};
use std::path::Path;

/// Reads a fragment list.
///
/// # Errors
/// [`SceneError`] names the file, the array, the entry and what is expected there.
pub fn read(path: &Path) -> Result<FragmentList, SceneError> {
    let npz = Npz::read(
        path,
        &["offsets", "view_z", "alpha", "color", "width", "height", "near", "far"],
    )?;
    let view_z = vector(&npz, "view_z", npz.required::<f32>("view_z")?)?;
    let alpha = vector(&npz, "alpha", npz.required::<f32>("alpha")?)?;
    let offsets = offsets(&npz)?;
    let color = match npz.optional::<f32>("color")? {
        None => None,
        Some(color) => match *color.shape() {
            [n, 3] => {
                let flat: Vec<f32> = color.iter().copied().collect();
                debug_assert_eq!(flat.len(), 3 * n);
                Some(flat.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
            }
            _ => {
                return Err(npz
                    .wrong("color", format!("shape {:?}", color.shape()), "[F, 3]")
                    .into());
            }
        },
    };
    let content = |source: FragmentError| SceneError::Content {
        path: path.to_owned(),
        source,
    };
    let mut list = FragmentList::new(offsets, view_z, alpha, color).map_err(content)?;
    match (scalar(&npz, "width")?, scalar(&npz, "height")?) {
        (Some(w), Some(h)) => {
            list = list
                .with_size(whole(&npz, "width", w)?, whole(&npz, "height", h)?)
                .map_err(content)?
        }
        (None, None) => {}
        _ => {
            return Err(npz
                .wrong("width, height", "only one of them is there", "both or none")
                .into());
        }
    }
    match (scalar(&npz, "near")?, scalar(&npz, "far")?) {
        (Some(near), Some(far)) => {
            let planes = CameraPlanes::new(near as f32, far as f32).map_err(|e| content(e.into()))?;
            list = list.with_planes(planes);
        }
        (None, None) => {}
        _ => {
            return Err(npz
                .wrong("near, far", "only one of them is there", "both or none")
                .into());
        }
    }
    Ok(list)
}

/// Writes a fragment list.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write(path: &Path, replace: Replace, list: &FragmentList) -> Result<(), FileError> {
    let mut arrays = vec![
        ("offsets", encode(ArrayView1::from(list.offsets()))),
        ("view_z", encode(ArrayView1::from(list.view_z()))),
        ("alpha", encode(ArrayView1::from(list.alpha()))),
    ];
    if let Some(color) = list.color() {
        let flat = color.as_flattened();
        let view = ArrayView2::from_shape((color.len(), 3), flat).expect("three channels a colour");
        arrays.push(("color", encode(view)));
    }
    if let Some((width, height)) = list.size() {
        arrays.push(("width", encode(arr0(width).view())));
        arrays.push(("height", encode(arr0(height).view())));
    }
    if let Some(planes) = list.planes() {
        arrays.push(("near", encode(arr0(planes.near()).view())));
        arrays.push(("far", encode(arr0(planes.far()).view())));
    }
    write_npz(path, replace, &arrays)
}

fn vector<T: Element>(npz: &Npz, name: &str, array: ndarray::ArrayD<T>) -> Result<Vec<T>, NpyError> {
    match array.ndim() {
        1 => Ok(array.iter().copied().collect()),
        _ => Err(npz.wrong(name, format!("shape {:?}", array.shape()), "one dimension")),
    }
}

/// Offsets of either unsigned width; NumPy's default signed integers are taken too where none is negative.
fn offsets(npz: &Npz) -> Result<Vec<u64>, NpyError> {
    const NAME: &str = "offsets";
    let signed = |values: Vec<i64>| {
        values
            .iter()
            .enumerate()
            .map(|(i, &v)| {
                u64::try_from(v).map_err(|_| npz.wrong(NAME, format!("offsets[{i}] = {v}"), "no negative offset"))
            })
            .collect()
    };
    let wrong_type = match npz.required::<u64>(NAME) {
        Ok(array) => return vector(npz, NAME, array),
        Err(missing @ NpyError::Missing { .. }) => return Err(missing),
        Err(error) => error,
    };
    if let Ok(array) = npz.required::<u32>(NAME) {
        return Ok(vector(npz, NAME, array)?.into_iter().map(u64::from).collect());
    }
    if let Ok(array) = npz.required::<i64>(NAME) {
        return signed(vector(npz, NAME, array)?);
    }
    if let Ok(array) = npz.required::<i32>(NAME) {
        return signed(vector(npz, NAME, array)?.into_iter().map(i64::from).collect());
    }
    Err(match wrong_type {
        NpyError::Array { path, name, reason, .. } => NpyError::Array {
            path,
            name,
            reason,
            expected: "a whole NumPy array of uint32 or uint64".to_owned(),
        },
        other => other,
    })
}

/// A single number of any of NumPy's usual types.
fn scalar(npz: &Npz, name: &str) -> Result<Option<f64>, NpyError> {
    fn one<T: Element + TryInto<f64>>(npz: &Npz, name: &str) -> Option<Result<Option<f64>, NpyError>> {
        let array = match npz.optional::<T>(name) {
            Ok(None) => return Some(Ok(None)),
            Ok(Some(array)) => array,
            Err(_) => return None,
        };
        Some(match (array.len(), array.first()) {
            (1, Some(&value)) => Ok(value.try_into().ok()),
            _ => Err(npz.wrong(name, format!("shape {:?}", array.shape()), "a single number")),
        })
    }
    if let Some(found) = one::<f32>(npz, name)
        .or_else(|| one::<u32>(npz, name))
        .or_else(|| one::<f64>(npz, name))
        .or_else(|| one::<i32>(npz, name))
    {
        return found;
    }
    // 64-bit integers do not convert to f64 without loss; a width or height that needs them is absurd anyway.
    match npz.optional::<i64>(name) {
        Ok(Some(array)) if array.len() == 1 => Ok(array.first().map(|&v| v as f64)),
        _ => Err(npz.wrong(
            name,
            "not a number of a usual type",
            "one float32, float64, int32, int64 or uint32",
        )),
    }
}

fn whole(npz: &Npz, name: &str, value: f64) -> Result<u32, NpyError> {
    if value >= 0.0 && value <= f64::from(u32::MAX) && value.fract() == 0.0 {
        Ok(value as u32)
    } else {
        Err(npz.wrong(name, format!("{value}"), "a whole number of pixels"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn round_trip(list: &FragmentList) -> FragmentList {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("list.npz");
        write(&path, Replace::No, list).unwrap();
        read(&path).unwrap()
    }

    #[test]
    fn everything_survives() {
        let list = FragmentList::new(
            vec![0, 0, 2, 2],
            vec![1.0, 2.0],
            vec![0.0, 1.0],
            Some(vec![[0.1, 0.2, 0.3], [1.0, 0.0, 0.5]]),
        )
        .unwrap()
        .with_size(3, 1)
        .unwrap()
        .with_planes(CameraPlanes::new(0.5, 10.0).unwrap());
        assert_eq!(round_trip(&list), list);
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap();
        assert_eq!(round_trip(&none), none);
    }

    proptest! {
        #[test]
        fn any_valid_list_survives(counts in prop::collection::vec(0u64..5, 0..20), salt in 1u32..1000) {
            let mut offsets = vec![0];
            for c in counts { offsets.push(offsets[offsets.len() - 1] + c); }
            let n = offsets[offsets.len() - 1] as usize;
            let view_z = (0..n).map(|i| (i as f32 + 1.0) / salt as f32).collect();
            let alpha = (0..n).map(|i| (i % 7) as f32 / 6.0).collect();
            let list = FragmentList::new(offsets, view_z, alpha, None).unwrap();
            prop_assert_eq!(round_trip(&list), list);
        }
    }

    #[test]
    fn foreign_types_and_shapes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("f.npz");
        let f = |values: &[f32]| encode(ArrayView1::from(values));
        let write = |arrays: &[(&str, Vec<u8>)]| write_npz(&path, Replace::Yes, arrays).unwrap();
        // NumPy's default integers are accepted, and so are a width and height of that type.
        write(&[
            ("offsets", encode(ArrayView1::from(&[0i64, 1]))),
            ("view_z", f(&[1.0])),
            ("alpha", f(&[0.5])),
            ("width", encode(arr0(1i64).view())),
            ("height", encode(arr0(1i64).view())),
            ("near", encode(arr0(0.5f64).view())),
            ("far", encode(arr0(2.0f64).view())),
        ]);
        assert_eq!(read(&path).unwrap().size(), Some((1, 1)));
        let ok = ("offsets", encode(ArrayView1::from(&[0u32, 1])));
        type Case<'a> = (Vec<(&'a str, Vec<u8>)>, &'a str);
        let cases: [Case<'_>; 6] = [
            (
                vec![
                    ("offsets", encode(ArrayView1::from(&[0i64, -1]))),
                    ("view_z", f(&[1.0])),
                    ("alpha", f(&[0.5])),
                ],
                "offsets[1] = -1",
            ),
            (
                vec![("offsets", f(&[0.0, 1.0])), ("view_z", f(&[1.0])), ("alpha", f(&[0.5]))],
                "expected a whole NumPy array of uint32 or uint64",
            ),
            (vec![ok.clone(), ("view_z", f(&[1.0]))], "there is no array 'alpha'"),
            (
                vec![
                    ok.clone(),
                    ("view_z", f(&[1.0])),
                    ("alpha", f(&[0.5])),
                    ("color", f(&[0.5])),
                ],
                "expected [F, 3]",
            ),
            (
                vec![
                    ok.clone(),
                    ("view_z", f(&[1.0])),
                    ("alpha", f(&[0.5])),
                    ("width", encode(arr0(1u32).view())),
                ],
                "only one of them",
            ),
            (
                vec![
                    ok,
                    ("view_z", encode(ArrayView1::from(&[1.0f64]))),
                    ("alpha", f(&[0.5])),
                ],
                "expected a whole NumPy array of float32",
            ),
        ];
        for (arrays, part) in cases {
            write(&arrays);
            let message = read(&path).unwrap_err().to_string();
            assert!(message.contains(part) && message.contains("f.npz"), "{message}");
        }
    }
}
