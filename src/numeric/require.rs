//! Tools that a machine may have or lack, and the variable that makes one of them a condition.
//!
//! A missing tool is reported as skipped. `NMT_REQUIRE=gpu,onnxruntime,...` turns the skip into a failure, in tests as
//! in `nmt check`.

use std::fmt::Display;

/// The environment variable that names required tools, separated by commas or spaces.
pub const VARIABLE: &str = "NMT_REQUIRE";

/// Every name that the variable may hold.
pub const TOOLS: [&str; 9] = [
    "onnxruntime",
    "glslangValidator",
    "slangc",
    "spirv-val",
    "gpu",
    "cuda",
    "python",
    "c++",
    "browser",
];

/// The names in a list that is separated by commas or spaces.
pub fn names(list: &str) -> Vec<String> {
    list.split([',', ' '])
        .filter(|name| !name.is_empty())
        .map(str::to_owned)
        .collect()
}

/// The tools that [`VARIABLE`] names.
pub fn required() -> Vec<String> {
    names(&std::env::var(VARIABLE).unwrap_or_default())
}

/// For tests: what was found of a tool, or none with a line on stderr where it is missing.
///
/// # Panics
/// Where [`VARIABLE`] names the tool that is missing, or where [`TOOLS`] does not have it.
pub fn or_skip<T, E: Display>(tool: &str, found: Result<T, E>) -> Option<T> {
    assert!(
        TOOLS.contains(&tool),
        "'{tool}' is not among the tools that can be required"
    );
    match found {
        Ok(found) => Some(found),
        Err(why) => {
            assert!(!required().iter().any(|name| name == tool), "{tool} is required: {why}");
            eprintln!("SKIPPED: {tool}: {why}");
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_take_commas_and_spaces() {
        assert_eq!(names("gpu, slangc  node,"), ["gpu", "slangc", "node"]);
        assert!(names(" , ").is_empty());
        assert_eq!(or_skip("gpu", Ok::<_, String>(5)), Some(5));
    }

    /// Control: a tool that nobody can require is a mistake of the caller.
    #[test]
    #[should_panic(expected = "'tea' is not among")]
    fn unknown_tools_are_refused() {
        let _: Option<()> = or_skip("tea", Ok::<_, String>(()));
    }
}
