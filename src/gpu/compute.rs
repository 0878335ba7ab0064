//! An exported function run over rows in a compute shader.

use super::device::{Dispatch, Gpu, GpuError, groups};
use crate::export::dialect::{Glsl, Wgsl};
use crate::numeric::source::Dialect;

/// Source of an exported function.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// WGSL.
    Wgsl(&'a str),
    /// GLSL, which naga turns into WGSL.
    Glsl(&'a str),
}

/// Entry point of the wrappers below.
const ENTRY: &str = "nmt_rows";

/// Runs a function of `width` numbers in one value ([`Type::Reals`](crate::numeric::source::Type::Reals)) once a row.
///
/// # Shapes
/// `rows: [N, W]`, row by row; the result is `[N]`.
///
/// # Errors
/// [`GpuError`]: the source is refused, or the rows do not fit.
pub fn run_rows(
    gpu: &Gpu,
    source: Source<'_>,
    function: &str,
    rows: &[f32],
    width: usize,
) -> Result<Vec<f32>, GpuError> {
    let count = rows.len() / width;
    let wgsl = match source {
        Source::Wgsl(text) => wrap_wgsl(text, function, width),
        Source::Glsl(text) => wgsl_of_glsl(&wrap_glsl(text, function, width))?,
    };
    // GLSL has no entry point but main.
    let entry = if matches!(source, Source::Wgsl(_)) {
        ENTRY
    } else {
        "main"
    };
    let pipeline = gpu.compute(function, &wgsl, entry)?;
    let input = gpu.upload("rows", rows)?;
    let output = gpu.zeros("answers", 4 * count as u64)?;
    let size = gpu.upload("number of rows", &[count as u32])?;
    gpu.run(
        function,
        &[Dispatch {
            pipeline: &pipeline,
            buffers: &[&input, &output, &size],
            groups: groups(count as u64),
        }],
    )?;
    gpu.download(&output, count)
}

fn loads(width: usize, wgsl: bool) -> Vec<String> {
    let base = if wgsl { "row * " } else { "int(row) * " };
    let suffix = if wgsl { "u" } else { "" };
    (0..width)
        .map(|i| format!("nmt_rows_in[{base}{width}{suffix} + {i}{suffix}]"))
        .collect()
}

/// The source with a compute shader behind it. A directive such as `enable f16;` stays first.
fn wrap_wgsl(text: &str, function: &str, width: usize) -> String {
    format!(
        "{text}
@group(0) @binding(0) var<storage, read> nmt_rows_in: array<f32>;
@group(0) @binding(1) var<storage, read_write> nmt_rows_out: array<f32>;
@group(0) @binding(2) var<storage, read> nmt_rows_count: array<u32>;

@compute @workgroup_size(64)
fn {ENTRY}(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {{
    let row = id.x + id.y * groups.x * 64u;
    if (row < nmt_rows_count[0]) {{
        nmt_rows_out[row] = {function}({row});
    }}
}}
",
        row = Wgsl.numbers(&loads(width, true))
    )
}

fn wrap_glsl(text: &str, function: &str, width: usize) -> String {
    format!(
        "#version 450
{text}
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer NmtIn {{ float nmt_rows_in[]; }};
layout(std430, set = 0, binding = 1) buffer NmtOut {{ float nmt_rows_out[]; }};
layout(std430, set = 0, binding = 2) readonly buffer NmtCount {{ uint nmt_rows_count[]; }};

void main() {{
    uint row = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * 64u;
    if (row < nmt_rows_count[0]) {{
        nmt_rows_out[int(row)] = {function}({numbers});
    }}
}}
",
        numbers = Glsl.numbers(&loads(width, false))
    )
}

/// WGSL of a GLSL compute shader.
pub(super) fn wgsl_of_glsl(text: &str) -> Result<String, GpuError> {
    let refused = |reason: String| GpuError::Source {
        label: "GLSL through naga".to_owned(),
        reason,
    };
    let mut parser = naga::front::glsl::Frontend::default();
    let options = naga::front::glsl::Options::from(naga::ShaderStage::Compute);
    let module = parser
        .parse(&options, text)
        .map_err(|e| refused(e.emit_to_string(text)))?;
    let mut validator = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::default(),
    );
    let info = validator
        .validate(&module)
        .map_err(|e| refused(e.emit_to_string(text)))?;
    naga::back::wgsl::write_string(&module, &info, naga::back::wgsl::WriterFlags::empty())
        .map_err(|e| refused(e.to_string()))
}
