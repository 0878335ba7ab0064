//! Deep weighted blended transparency: weighted blended, its weight function a small network.

use super::capabilities::{Capabilities, Needs};
use super::registry::{Arguments, Entry, ParseError};
use super::{Accumulated, Context, Method, MethodError, neural::Neural};
use crate::features::FeatureSet;
use crate::model::{Mlp, file};
use crate::pixel::FragmentList;
use std::path::Path;

/// Its name on the command line.
pub const NAME: &str = "deep-weighted-blended";

/// DWB22 Sec. 3.3: sum of alpha and number of fragments in RG16F, what is left of the background in R16F.
pub const CAPABILITIES: Capabilities = Capabilities {
    bits_per_pixel: Some(48),
    needs: Needs::NONE,
    ..Capabilities::of_sums(3, false)
};

/// The network was made for other features.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("network '{network}' takes the features '{}', but {NAME} needs '{}'; use it as neural:MODEL, or train one by \
    configs/{NAME}.toml", found.name(), FeatureSet::DeepWeightedBlended.name())]
pub struct WrongFeatures {
    network: String,
    found: FeatureSet,
}

/// A network that estimates the front-to-back factor of a fragment from its depth and its pixel's sum of alpha and
/// number of fragments; the factor is the weight: C = Σ w a C/Σ w a · (1 − e^−b0) + e^−b0 C_bg.
///
/// DWB22's text gives the composite of weighted blended; its listing multiplies by the weight once more, which is not
/// followed. The activation of its output is not stated; here it is a sigmoid, which keeps the weight in (0, 1).
///
/// # Source
/// DWB22 Sec. 3.3: 3-10-8-1, ReLU, trained on Adst of Eq. 3.3 by Adam at 10^−4 on the mean squared error, batch 128,
/// 150 epochs.
pub struct DeepWeightedBlended {
    network: Neural,
}

/// The method by its name, with the network that is shipped in `models/`.
pub const ENTRY: Entry = Entry {
    head: NAME,
    pattern: NAME,
    source: "Papakostas, MSc thesis, Ioannina 2022",
    names: |head| vec![head.to_owned()],
    build,
};

/// The shipped network; configs/deep-weighted-blended.toml trains it.
const SHIPPED: &[u8] = include_bytes!("../../models/deep-weighted-blended.json");

fn build(arguments: &Arguments<'_>) -> Result<Box<dyn Method>, ParseError> {
    arguments.no_own()?;
    arguments.no_argument()?;
    let mlp = file::from_json(SHIPPED, Path::new("models/deep-weighted-blended.json")).map_err(|source| {
        ParseError::Model {
            name: arguments.name.to_owned(),
            source,
        }
    })?;
    Ok(Box::new(DeepWeightedBlended::new(mlp)?))
}

impl DeepWeightedBlended {
    /// The method that asks this network.
    ///
    /// # Errors
    /// [`WrongFeatures`] where it is not one of [`FeatureSet::DeepWeightedBlended`].
    pub fn new(mlp: Mlp) -> Result<Self, WrongFeatures> {
        match mlp.feature_set() {
            FeatureSet::DeepWeightedBlended => Ok(Self {
                network: Neural::new(mlp),
            }),
            found => Err(WrongFeatures {
                network: mlp.name().to_owned(),
                found,
            }),
        }
    }
}

impl Method for DeepWeightedBlended {
    fn name(&self) -> String {
        NAME.to_owned()
    }

    fn capabilities(&self) -> Capabilities {
        CAPABILITIES
    }

    fn accumulate<'a>(
        &'a self,
        list: &'a FragmentList,
        context: Context,
    ) -> Result<Box<dyn Accumulated + 'a>, MethodError> {
        self.network.accumulate(list, context)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::{Dataset, DatasetConfig, build, build_from_lists};
    use crate::model::mlp::tests::random_mlp;
    use crate::model::{Dense, Provenance};
    use crate::oit::testing::*;
    use crate::oit::weighted_blended::{Weight, WeightedBlended};
    use crate::synth::SynthConfig;
    use crate::train::trainer::Job;
    use crate::train::{Backend, Outcome, TrainConfig, train};

    /// The part of the configuration that the library knows.
    #[derive(serde::Deserialize)]
    struct Config {
        name: String,
        seed: u64,
        synth: SynthConfig,
        dataset: DatasetConfig,
        train: TrainConfig,
    }

    fn config() -> Config {
        toml::from_str(include_str!("../../configs/deep-weighted-blended.toml")).unwrap()
    }

    /// Sigmoid of a weighted sum of the features.
    fn linear(weights: [f32; 3], bias: f32) -> DeepWeightedBlended {
        let layer = Dense::new(3, 1, weights.to_vec(), vec![bias]).unwrap();
        DeepWeightedBlended::new(
            Mlp::new("x", FeatureSet::DeepWeightedBlended, vec![layer], Provenance::default()).unwrap(),
        )
        .unwrap()
    }

    fn trained(dataset: &Dataset, config: &TrainConfig) -> Mlp {
        let folder = tempfile::tempdir().unwrap();
        let checkpoint = folder.path().join("c.json");
        let provenance = Provenance::default();
        let job = Job {
            name: "deep",
            config,
            seed: 5,
            backend: Backend::Fused,
            checkpoint: &checkpoint,
            resume: false,
            provenance,
        };
        match train(dataset, &job, &|| false, &mut |_| {}).unwrap() {
            Outcome::Finished { mlp, .. } => *mlp,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_config_is_the_published_recipe() {
        let Config {
            name,
            synth,
            dataset,
            train,
            ..
        } = config();
        synth.validate().unwrap();
        dataset.validate().unwrap();
        train.validate().unwrap();
        assert_eq!(
            (name.as_str(), dataset.features),
            (NAME, FeatureSet::DeepWeightedBlended)
        );
        assert_eq!(
            (train.hidden, train.epochs, train.batch, train.learning_rate),
            (vec![10, 8], 150, 128, 1e-4)
        );
        assert_eq!((dataset.training_pairs, dataset.validation_pairs), (250_000, 50_000));
    }

    #[test]
    fn one_two_and_three_fragments_by_hand() {
        // A constant weight gives the mean.
        let constant = linear([0.0; 3], 0.0);
        assert_close(&image(&constant, &one())[0], &[0.625, 0.5, 0.5]);
        assert_close(&image(&constant, &two())[0], &[0.625, 0.625, 0.25]);
        // Weight 1/(1 + e^(ln 3 d)): 1/2 in front (d = 0), 1/4 behind (d = 1). Tolerance: a forward pass in f32.
        let falling = linear([-(3.0f32.ln()), 0.0, 0.0], 0.0);
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(
            near(image(&falling, &two())[0], [0.75, 0.5, 0.25]),
            "2/3 red and 1/3 green are the over operator here"
        );
        // d = 1/3: 1/(1 + 3^(1/3)).
        let (w, green) = ([0.25, 0.5, 0.0], 1.0 / (1.0 + 3f64.cbrt()));
        let total = w[0] + w[1] + green;
        assert!(near(
            image(&falling, &three())[0],
            [w[1], green, w[0]].map(|w| 0.875 * w / total + 0.125)
        ));
        assert!(!near(image(&constant, &three())[0], image(&falling, &three())[0]));
    }

    #[test]
    fn one_colour_stays_and_order_never_matters() {
        let (method, list) = (linear([-3.0, 0.1, -0.2], 1.0), scene(4));
        assert!(!order_matters(&method, &list));
        let white = image(&method, &painted(&list, [1.0; 3]));
        assert_close(white.as_flattened(), &vec![1.0; 3 * white.len()]);
        let empty = FragmentList::new(vec![0, 0], vec![], vec![], Some(vec![])).unwrap();
        assert_eq!(image(&method, &empty), [WHITE]);
    }

    #[test]
    fn other_networks_are_refused() {
        let error = DeepWeightedBlended::new(random_mlp(&[4], 1))
            .map(drop)
            .unwrap_err()
            .to_string();
        assert!(
            error.starts_with("network 'random' takes the features 'paper'"),
            "{error}"
        );
    }

    /// A tiny training, from lists and from random pixels, beats the best constant, and its image that of a constant
    /// weight on pixels it never saw.
    #[test]
    fn our_own_toolchain_trains_it() {
        let Config {
            seed,
            synth,
            dataset,
            train,
            ..
        } = config();
        let train = TrainConfig {
            epochs: 30,
            learning_rate: 3e-3,
            ..train
        };
        let sizes = DatasetConfig {
            training_pairs: 3500,
            validation_pairs: 1000,
            ..dataset
        };
        let (one, other) = (scene(1), scene(2));
        let from_lists = build_from_lists("tiny", seed, &[("one", &one)], &sizes).unwrap();
        let random = build("tiny", seed, &synth, &sizes, &|_| {}).unwrap();
        for dataset in [from_lists, random] {
            let targets = &dataset.validation.targets;
            let mean = targets.iter().sum::<f32>() / targets.len() as f32;
            let variance = targets.iter().map(|t| f64::from(t - mean).powi(2)).sum::<f64>() / targets.len() as f64;
            let mlp = trained(&dataset, &train);
            assert_eq!(mlp.shape(), "3-10-8-1");
            let loss = mlp.provenance.validation_loss.unwrap();
            assert!(loss < 0.5 * variance, "{loss} of {variance}");
            let constant = image_mse(
                &WeightedBlended {
                    weight: Weight::Dwb22,
                    ..WeightedBlended::default()
                },
                &other,
            );
            let ours = image_mse(&DeepWeightedBlended::new(mlp).unwrap(), &other);
            assert!(ours < constant, "{ours} against {constant}");
        }
    }
}
