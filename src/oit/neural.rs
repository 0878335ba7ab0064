//! Neural moment transparency: a network answers from moments.

use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError, deep_weighted_blended};
use crate::features::{Extractor, FeatureSet, Look};
use crate::model::{Mlp, file};
use crate::pixel::FragmentList;
use std::path::Path;

/// A network as a transparency method.
pub struct Neural {
    mlp: Mlp,
}

/// The method by its name, `neural:MODEL`; it is in no list of all methods, since it needs a file.
pub const ENTRY: Entry = Entry { head: "neural", pattern: "neural:MODEL", names: |_| Vec::new(), build };

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    let path = arguments.argument.ok_or_else(|| arguments.wrong("expected the path of a model file"))?;
    let mlp = file::load(Path::new(path)).map_err(|source| ParseError::Model { name: arguments.name.to_owned(), source })?;
    Ok(Box::new(Neural::new(mlp)))
}

impl Neural {
    /// The method that asks this network.
    pub fn new(mlp: Mlp) -> Self {
        Self { mlp }
    }

    fn error(&self, source: crate::pixel::DepthError) -> MethodError {
        MethodError::Depth { method: self.name(), source }
    }

    /// The network's answer (transmittance, or the like) for every fragment of a list, in its order; features in f64 rounded to f32, forward pass in f32.
    ///
    /// `progress` is told how many fragments are done.
    ///
    /// # Errors
    /// [`MethodError::Depth`] where camera planes are needed and unknown, a fragment lies outside them, or the depth range is none.
    pub fn transmittance(&self, list: &FragmentList, context: Context, progress: &dyn Fn(u64)) -> Result<Vec<f32>, MethodError> {
        // Pixels are taken in runs of about this many fragments, so that their features stay a few megabytes.
        const RUN: u64 = 1 << 18;
        let extractor = Extractor::for_list(self.mlp.feature_set(), list, context.planes, context.depth_range).map_err(|e| self.error(e))?;
        let offsets = list.offsets();
        let mut out = Vec::with_capacity(list.len());
        let mut first = 0;
        while first < list.pixels() {
            let end = offsets.partition_point(|&o| o < offsets[first] + RUN).clamp(first + 1, list.pixels());
            let Look { known, features } = extractor.list(list, first..end).map_err(|e| self.error(e))?;
            let mut asked = self.mlp.predict(&features).into_iter();
            out.extend(known.into_iter().map(|t| if t.is_nan() { asked.next().expect("one answer a question") } else { t }));
            first = end;
            progress(out.len() as u64);
        }
        Ok(out)
    }
}

impl Method for Neural {
    fn name(&self) -> String {
        format!("neural:{}", self.mlp.name())
    }

    /// NMT24 Sec. 4: RGBA32F colour and normalisation, RGBA32F moments, RG32F b0 and weight sum, RG16F depth range.
    fn bits_per_pixel(&self) -> u32 {
        match self.mlp.feature_set() {
            FeatureSet::Paper => 352,
            FeatureSet::DeepWeightedBlended => deep_weighted_blended::BITS_PER_PIXEL,
            // RGBA32F colour and weight sum, R32F b0, R16F count, RG32F depth range, and as many f32 as there are moments.
            set => 128 + 32 + 16 + 64 + 32 * set.moments() as u32,
        }
    }

    fn accumulate<'a>(&'a self, list: &'a FragmentList, context: Context) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        Ok(Box::new(Answers { list, transmittance: self.transmittance(list, context, &|_| {})? }))
    }
}

/// All answers of a network; they are cheaper to ask for at once.
struct Answers<'a> {
    list: &'a FragmentList,
    transmittance: Vec<f32>,
}

impl Accumulated for Answers<'_> {
    fn weights(&self, p: usize, out: &mut [f64]) {
        for (out, &t) in out.iter_mut().zip(&self.transmittance[self.list.range(p)]) {
            *out = t.into();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::mlp::tests::random_mlp;
    use crate::oit;
    use crate::pixel::CameraPlanes;

    /// Two fragments need no network, whatever it says; of five the ends do not, and all answers lie between the total transmittance and 1.
    #[test]
    fn what_is_known_is_not_asked() {
        let view_z = vec![2.0, 1.0, 4.0, 1.5, 2.5, 3.0, 7.0];
        let alpha = vec![0.5, 0.25, 0.9, 0.3, 0.6, 0.2, 0.7];
        let list = FragmentList::new(vec![0, 2, 7], view_z, alpha, None).unwrap();
        let mlp = Mlp::new("r", FeatureSet::Recentred, random_mlp(&[4], 1).layers().to_vec(), crate::model::Provenance::default()).unwrap();
        let found = Neural::new(mlp).transmittance(&list, Context::default(), &|_| {}).unwrap();
        let exact = crate::pixel::abuffer::list_transmittance(&list);
        for known in [0, 1, 3, 6] {
            assert!((f64::from(found[known]) - exact[known]).abs() < 1e-6, "{known}");
        }
        assert_eq!((found[1], found[3]), (1.0, 1.0));
        let total = exact[6] as f32 * 0.3;
        assert!([2, 4, 5].iter().all(|&i| found[i] >= total && found[i] <= 1.0));
    }

    #[test]
    fn answers_stand_in_the_order_of_the_list() {
        let list = FragmentList::new(vec![0, 0, 2, 3], vec![2.0, 1.0, 4.0], vec![0.5, 0.25, 1.0], None).unwrap();
        let planes = CameraPlanes::new(0.5, 8.0).unwrap();
        let method = Neural::new(random_mlp(&[4], 1));
        assert!(matches!(method.accumulate(&list, Context::default()), Err(MethodError::Depth { .. })));
        let context = Context { planes: Some(planes), ..Context::default() };
        let all = oit::weights(&list, &*method.accumulate(&list, context).unwrap());
        let rows = Extractor::new(FeatureSet::Paper, Some(planes), None).unwrap().list(&list, 1..2).unwrap().features;
        assert_eq!(all[..2], random_mlp(&[4], 1).predict(&rows).into_iter().map(f64::from).collect::<Vec<_>>());
        assert_eq!(all.len(), 3);
        let none = FragmentList::new(vec![0], vec![], vec![], None).unwrap().with_planes(planes);
        assert!(method.transmittance(&none, Context::default(), &|_| {}).unwrap().is_empty());
    }
}
