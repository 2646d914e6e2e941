//! Compiles the shaders with shaderc (glslang), warnings as errors.

use std::fs;
use std::path::Path;

use shaderc::{
    CompileOptions, Compiler, EnvVersion, OptimizationLevel, ResolvedInclude, ShaderKind, TargetEnv,
};

use super::{VARIANTS, manifest};

/// Compiles every shader of a folder in all variants, and writes modules and manifests to another. The error is the
/// compiler's text.
pub(crate) fn compile(glsl: &Path, spirv: &Path) -> Result<(), String> {
    let compiler = Compiler::new().expect("shaderc starts");
    for path in manifest::shaders(glsl) {
        let kind = match path.extension().and_then(|e| e.to_str()) {
            Some("comp") => ShaderKind::Compute,
            Some("vert") => ShaderKind::Vertex,
            Some("mesh") => ShaderKind::Mesh,
            _ => ShaderKind::Fragment,
        };
        let name = path.to_string_lossy();
        let source = fs::read_to_string(&path).map_err(|error| format!("{name}: {error}"))?;
        for (variant, define) in VARIANTS {
            let mut options = CompileOptions::new().expect("shaderc options");
            // For 1.3 glslang would write LocalSizeId, which needs maintenance4 and complicates reflection.
            options.set_target_env(TargetEnv::Vulkan, EnvVersion::Vulkan1_2 as u32);
            // The bound variant serves the validation layer and reflection: it keeps names and every declared buffer.
            // CPU drivers get the mixed variant as it is: their tiles take 1.3 times as long from optimised modules.
            let optimise = match variant {
                "address" => OptimizationLevel::Performance,
                _ => OptimizationLevel::Zero,
            };
            options.set_optimization_level(optimise);
            options.set_warnings_as_errors();
            if let Some(define) = define {
                options.add_macro_definition(define, Some("1"));
            }
            options.set_include_callback(|file, _, _, _| {
                let content =
                    fs::read_to_string(glsl.join(file)).map_err(|e| format!("{file}: {e}"))?;
                Ok(ResolvedInclude {
                    resolved_name: file.into(),
                    content,
                })
            });
            let made = compiler
                .compile_into_spirv(&source, kind, &name, "main", Some(&options))
                .map_err(|error| error.to_string())?;
            let module = manifest::module_path(spirv, &path, variant);
            fs::write(module, made.as_binary_u8()).map_err(|error| error.to_string())?;
        }
        let text = manifest::manifest(glsl, &path, spirv);
        fs::write(manifest::manifest_path(spirv, &path), text).map_err(|e| e.to_string())?;
    }
    Ok(())
}
