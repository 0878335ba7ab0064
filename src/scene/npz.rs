//! The fragment list as an `.npz` file: the exchange format for pixels of any renderer.
//!
//! `offsets` u32 or u64 `[P + 1]`, `view_z` f32 `[F]`, `alpha` f32 `[F]`; optional `color` f32 `[F, 3]`, `width`,
//! `height`, `near`, `far`, and where a deep image was not at its origin `data_window`, `display_window` i32 `[4]`.
//! Other arrays are named in [`FragmentList::left_out`].

use super::{ListFormat, SceneError};
use crate::numeric::file::{FileError, Replace};
use crate::numeric::npy::{Element, Entry, NpyError, Npz, encode, write_npz_of};
use crate::pixel::{CameraPlanes, FragmentError, FragmentList, LeftOut, Windows};
use ndarray::{ArrayView1, ArrayView2, arr0};
use std::path::Path;

/// The arrays of a list.
const NAMES: [&str; 10] = [
    "offsets",
    "view_z",
    "alpha",
    "color",
    "width",
    "height",
    "near",
    "far",
    "data_window",
    "display_window",
];

/// `.npz`.
pub(super) const FORMAT: ListFormat = ListFormat {
    ending: "npz",
    read: |path, part| match part {
        None => read(path),
        Some(_) => {
            let reason = "an archive has no parts; only deep images (.exr) do";
            Err(SceneError::file_content(path, "name", reason))
        }
    },
    write: |path, replace, list| Ok(write(path, replace, list)?),
};

/// Reads a fragment list.
///
/// # Errors
/// [`SceneError`] names the file, the array, the entry and what is expected there.
pub fn read(path: &Path) -> Result<FragmentList, SceneError> {
    let npz = Npz::read(path, &NAMES)?;
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
    if let (Some(data), Some(display)) = (window(&npz, "data_window")?, window(&npz, "display_window")?) {
        list = list.with_windows(Windows { data, display }).map_err(content)?;
    }
    let others: Vec<&str> = npz.names().filter(|n| !NAMES.contains(n)).collect();
    let what = format!("arrays {}", others.join(", "));
    let remedy = format!("a fragment list is {}", NAMES.join(", "));
    Ok(list.with_left_out([LeftOut::new(
        what,
        path.display().to_string(),
        others.len() as u64,
        remedy,
    )]))
}

/// Four whole numbers of a window.
fn window(npz: &Npz, name: &str) -> Result<Option<[i32; 4]>, NpyError> {
    let Some(array) = npz.optional::<i32>(name)? else {
        return Ok(None);
    };
    let found = format!("shape {:?}", array.shape());
    let values = vector(npz, name, array)?;
    <[i32; 4]>::try_from(values)
        .map(Some)
        .map_err(|_| npz.wrong(name, found, "x_min, y_min, x_max, y_max"))
}

/// Writes a fragment list.
///
/// # Errors
/// [`FileError`]; nothing half-written is left.
pub fn write(path: &Path, replace: Replace, list: &FragmentList) -> Result<(), FileError> {
    let mut arrays = vec![
        ("offsets", Entry::streamed(ArrayView1::from(list.offsets()))),
        ("view_z", Entry::streamed(ArrayView1::from(list.view_z()))),
        ("alpha", Entry::streamed(ArrayView1::from(list.alpha()))),
    ];
    if let Some(color) = list.color() {
        let flat = color.as_flattened();
        let view = ArrayView2::from_shape((color.len(), 3), flat).expect("three channels a colour");
        arrays.push(("color", Entry::streamed(view)));
    }
    if let Some((width, height)) = list.size() {
        arrays.push(("width", Entry::Encoded(encode(arr0(width).view()))));
        arrays.push(("height", Entry::Encoded(encode(arr0(height).view()))));
    }
    if let Some(planes) = list.planes() {
        arrays.push(("near", Entry::Encoded(encode(arr0(planes.near()).view()))));
        arrays.push(("far", Entry::Encoded(encode(arr0(planes.far()).view()))));
    }
    if let Some(Windows { data, display }) = list.windows() {
        arrays.push(("data_window", Entry::Encoded(encode(ArrayView1::from(&data)))));
        arrays.push(("display_window", Entry::Encoded(encode(ArrayView1::from(&display)))));
    }
    write_npz_of(path, replace, &arrays)
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
    match npz.kind(NAME).as_deref() {
        Some("<u4" | "|u4") => Ok(vector(npz, NAME, npz.required::<u32>(NAME)?)?
            .into_iter()
            .map(u64::from)
            .collect()),
        Some("<i8") => signed(vector(npz, NAME, npz.required::<i64>(NAME)?)?),
        Some("<i4") => signed(
            vector(npz, NAME, npz.required::<i32>(NAME)?)?
                .into_iter()
                .map(i64::from)
                .collect(),
        ),
        _ => vector(npz, NAME, npz.required::<u64>(NAME)?),
    }
}

/// A single number of any of NumPy's whole and real types.
fn scalar(npz: &Npz, name: &str) -> Result<Option<f64>, NpyError> {
    fn one<T: Element>(npz: &Npz, name: &str, to_f64: impl Fn(T) -> f64) -> Result<Option<f64>, NpyError> {
        let Some(array) = npz.optional::<T>(name)? else {
            return Ok(None);
        };
        match (array.len(), array.first()) {
            (1, Some(&value)) => Ok(Some(to_f64(value))),
            _ => Err(npz.wrong(name, format!("shape {:?}", array.shape()), "a single number")),
        }
    }
    match npz.kind(name).as_deref() {
        None => Ok(None),
        Some("|u1") => one(npz, name, |v: u8| v.into()),
        Some("|i1") => one(npz, name, |v: i8| v.into()),
        Some("<u2") => one(npz, name, |v: u16| v.into()),
        Some("<i2") => one(npz, name, |v: i16| v.into()),
        Some("<u4") => one(npz, name, |v: u32| v.into()),
        Some("<i4") => one(npz, name, |v: i32| v.into()),
        // Where these lose anything, the number is absurd as a width or a plane anyway.
        Some("<u8") => one(npz, name, |v: u64| v as f64),
        Some("<i8") => one(npz, name, |v: i64| v as f64),
        Some("<f8") => one(npz, name, |v: f64| v),
        Some("<f4") => one(npz, name, |v: f32| v.into()),
        Some(_) => one(npz, name, |v: f32| v.into()),
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
    use crate::numeric::npy::write_npz;
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
                "write .astype(np.uint64)",
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
                "it is float64; write .astype(np.float32)",
            ),
        ];
        for (arrays, part) in cases {
            write(&arrays);
            let message = read(&path).unwrap_err().to_string();
            assert!(message.contains(part) && message.contains("f.npz"), "{message}");
        }
    }
}
