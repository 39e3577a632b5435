use crate::args::ProbeArgs;
use crate::error::CliError;
pub fn run(_: &ProbeArgs) -> Result<(), CliError> {
    Ok(())
}
